//! An object that reflects or diffracts a path: a wall, a pole, an edge, the floor or the ceiling.

/// One bounce of a path.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Bounce {
    /// A bounce at the wall with this index.
    Wall(u32),
    /// A bounce at the pole with this index.
    Pole(u32),
    /// Diffraction at the edge with this index, among [`Scene::edges`](super::Scene::edges).
    Edge(u32),
    /// A bounce at the floor. Bounces at floor and ceiling follow the others in the list, in their order along the
    /// path; lengths and heights determine their places between the walls.
    Floor,
    /// A bounce at the ceiling.
    Ceiling,
}

/// The number of the first edge, above all walls, and the numbers of floor and ceiling, above all edges.
const EDGES: i64 = 1 << 32;
const FLOOR: i64 = 1 << 33;
const CEILING: i64 = FLOOR + 1;

impl Bounce {
    /// Returns the number in files and in Python: a wall's index; -1 minus a pole's; 2^32 plus an edge's; 2^33 for the
    /// floor and one more for the ceiling.
    ///
    /// ```
    /// use eeruf_sim::Bounce;
    /// let all = [Bounce::Wall(3), Bounce::Pole(0), Bounce::Edge(1), Bounce::Floor, Bounce::Ceiling];
    /// assert_eq!(all.map(Bounce::number), [3, -1, 4_294_967_297, 8_589_934_592, 8_589_934_593]);
    /// assert_eq!(all.map(|bounce| Bounce::numbered(bounce.number())), all);
    /// ```
    pub fn number(self) -> i64 {
        match self {
            Self::Wall(wall) => i64::from(wall),
            Self::Pole(pole) => -1 - i64::from(pole),
            Self::Edge(edge) => EDGES + i64::from(edge),
            Self::Floor => FLOOR,
            Self::Ceiling => CEILING,
        }
    }

    /// Returns the bounce with this [`number`](Self::number).
    pub fn numbered(number: i64) -> Self {
        match number {
            ..0 => Self::Pole((-1 - number) as u32),
            0..EDGES => Self::Wall(number as u32),
            EDGES..FLOOR => Self::Edge((number - EDGES) as u32),
            FLOOR => Self::Floor,
            CEILING.. => Self::Ceiling,
        }
    }

    /// Returns true for floor and ceiling.
    pub fn is_vertical(self) -> bool {
        matches!(self, Self::Floor | Self::Ceiling)
    }

    /// Returns the bounces of a path in the plan: all except those at floor and ceiling, which come last.
    pub fn in_plan(bounces: &[Self]) -> &[Self] {
        let vertical = bounces.iter().rev().take_while(|bounce| bounce.is_vertical()).count();
        &bounces[..bounces.len() - vertical]
    }
}
