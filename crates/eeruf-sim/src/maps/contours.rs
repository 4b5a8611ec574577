//! The outlines of occupied cells: closed lines from corner to corner of cells.

/// A corner of cells, counted from the map's lower left.
pub(super) type Corner = [i64; 2];

/// Headings, counter-clockwise from along x.
const STEPS: [Corner; 4] = [[1, 0], [0, 1], [-1, 0], [0, -1]];

/// Returns the outlines of the occupied cells: closed lines through the corners at which they turn, with free space on
/// the left. Occupied cells that touch at a corner belong together, so that no sound slips through a slanted wall.
///
/// `occupied` is called only for cells inside `width` times `height`; nothing is occupied outside.
pub(super) fn contours(width: usize, height: usize, occupied: impl Fn(usize, usize) -> bool) -> Vec<Vec<Corner>> {
    let at = |x: i64, y: i64| {
        let inside = (0..width as i64).contains(&x) && (0..height as i64).contains(&y);
        inside && occupied(x as usize, y as usize)
    };
    // Directions that lead on from each corner: a bit for each heading.
    let (columns, rows) = (width + 1, height + 1);
    let mut directions = vec![0_u8; columns * rows];
    for y in 0..rows as i64 {
        for x in 0..columns as i64 {
            let [right_up, left_up, left_down, right_down] = [at(x, y), at(x - 1, y), at(x - 1, y - 1), at(x, y - 1)];
            // A way has a free cell on its left and an occupied one on its right.
            let sides = [(right_up, right_down), (left_up, right_up), (left_down, left_up), (right_down, left_down)];
            let bits = sides.iter().enumerate().filter(|(_, (left, right))| !left && *right);
            directions[y as usize * columns + x as usize] = bits.fold(0, |bits, (heading, _)| bits | 1 << heading);
        }
    }
    let mut found = Vec::new();
    for start in 0..directions.len() {
        while directions[start] != 0 {
            found.push(trace(&mut directions, columns, start));
        }
    }
    found
}

/// Follows one outline, and removes its directions from the map.
fn trace(directions: &mut [u8], columns: usize, start: usize) -> Vec<Corner> {
    let mut corners = Vec::new();
    let mut place = start;
    let first = directions[start].trailing_zeros() as usize;
    let mut heading = first;
    loop {
        directions[place] &= !(1 << heading);
        let [dx, dy] = STEPS[heading];
        place = (place as i64 + dy * columns as i64 + dx) as usize;
        // Try left, straight on, right: if two occupied cells touch at a corner, left stays at the same free cell.
        let next = [heading + 1, heading, heading + 3].map(|next| next % 4);
        let taken = next.into_iter().find(|&next| directions[place] & (1 << next) != 0);
        // If no direction is left, the outline closes here.
        let next = taken.unwrap_or(first);
        if next != heading {
            corners.push([(place % columns) as i64, (place / columns) as i64]);
        }
        if taken.is_none() {
            return corners;
        }
        heading = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn of(rows: &[&str]) -> Vec<Vec<Corner>> {
        // The first row is the highest.
        contours(rows[0].len(), rows.len(), |x, y| rows[rows.len() - 1 - y].as_bytes()[x] == b'#')
    }

    /// Returns twice the area on the left.
    fn area(corners: &[Corner]) -> i64 {
        let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
        pairs.map(|(a, b)| a[0] * b[1] - a[1] * b[0]).sum()
    }

    #[test]
    fn a_block_has_four_corners_with_what_is_free_on_the_left() {
        let found = of(&["....", ".##.", ".##.", "...."]);
        assert_eq!(found.len(), 1);
        assert_eq!((found[0].len(), area(&found[0])), (4, -8));
    }

    #[test]
    fn a_room_has_an_outline_outside_and_one_inside() {
        let found = of(&["####", "#..#", "#..#", "####"]);
        let mut areas: Vec<_> = found.iter().map(|corners| area(corners)).collect();
        areas.sort_unstable();
        assert_eq!(areas, [-32, 8]);
    }

    #[test]
    fn cells_that_touch_at_a_corner_have_one_outline() {
        let found = of(&["#..", ".#.", "..#"]);
        assert_eq!(found.len(), 1);
        assert_eq!(area(&found[0]), -6);
    }

    proptest! {
        #[test]
        fn outlines_enclose_as_much_as_is_occupied(cells in prop::collection::vec(prop::bool::ANY, 12 * 9)) {
            let found = contours(12, 9, |x, y| cells[y * 12 + x]);
            let enclosed: i64 = found.iter().map(|corners| area(corners)).sum();
            prop_assert_eq!(-enclosed, 2 * cells.iter().filter(|&&cell| cell).count() as i64);
        }
    }
}
