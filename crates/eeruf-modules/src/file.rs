//! Modules in files: a name, or a table of differences from a named one; one for all sensors, or a list.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeMap as _, Serializer};

use crate::aliases::like;
use crate::keys::{KEYS, ModuleError, Value};
use crate::module::Module;
use crate::presets::find;

/// A module's name, or a table of differences from the module that `like` names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModuleFile(pub Module);

/// A module for all sensors, or a list of one for each.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModulesFile {
    /// One module for all.
    All(Module),
    /// One module for each sensor, in order.
    Of(Vec<Module>),
}

impl ModulesFile {
    /// Returns one module for each of `sensors` sensors.
    ///
    /// # Errors
    /// The list has another length.
    pub fn list(&self, sensors: usize) -> Result<Vec<Module>, String> {
        match self {
            Self::All(module) => Ok(alloc::vec![*module; sensors]),
            Self::Of(list) if list.len() == sensors => Ok(list.clone()),
            Self::Of(list) => Err(alloc::format!(
                "module: {} modules; expected one for all, or one for each of {sensors} sensors",
                list.len()
            )),
        }
    }
}

fn named<E: Error>(name: &str) -> Result<Module, E> {
    find(name).or_else(|| like(name)).copied().ok_or_else(|| E::custom(ModuleError::Name(name)))
}

/// A number or a word of a table.
enum Figure {
    Number(f64),
    Word(String),
}

impl<'de> Deserialize<'de> for Figure {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FigureVisitor;
        impl Visitor<'_> for FigureVisitor {
            type Value = Figure;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number or a word")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<Figure, E> {
                Ok(Figure::Number(value as f64))
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<Figure, E> {
                Ok(Figure::Number(value as f64))
            }

            fn visit_f64<E: Error>(self, value: f64) -> Result<Figure, E> {
                Ok(Figure::Number(value))
            }

            fn visit_str<E: Error>(self, value: &str) -> Result<Figure, E> {
                Ok(Figure::Word(value.into()))
            }
        }
        deserializer.deserialize_any(FigureVisitor)
    }
}

struct ModuleVisitor;

impl<'de> Visitor<'de> for ModuleVisitor {
    type Value = Module;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a module's name, or a table with `like` and what differs")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Module, E> {
        named(name)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Module, A::Error> {
        let (mut like, mut figures) = (None, Vec::new());
        while let Some(key) = map.next_key::<String>()? {
            match map.next_value::<Figure>()? {
                Figure::Word(name) if key == "like" => like = Some(name),
                figure => figures.push((key, figure)),
            }
        }
        let like = like.ok_or_else(|| A::Error::custom("module: no `like`; expected the name of one that is alike"))?;
        let mut module = named(&like)?;
        for (key, figure) in &figures {
            let value = match figure {
                Figure::Number(number) => Value::Number(*number),
                Figure::Word(word) => Value::Word(word),
            };
            module.set(key, value).map_err(A::Error::custom)?;
        }
        module.check().map_err(A::Error::custom)?;
        Ok(module)
    }
}

impl<'de> Deserialize<'de> for ModuleFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ModuleVisitor).map(Self)
    }
}

impl Serialize for ModuleFile {
    /// The name of a preset, or a table of all figures.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self(module) = self;
        if find(module.name) == Some(module) {
            return serializer.serialize_str(module.name);
        }
        let mut table = serializer.serialize_map(Some(1 + KEYS.len()))?;
        table.serialize_entry("like", module.name)?;
        for key in &KEYS {
            match key.of(module) {
                Value::Number(number) if key.is_whole() => table.serialize_entry(key.name, &(number as i64))?,
                Value::Number(number) => table.serialize_entry(key.name, &number)?,
                Value::Word(word) => table.serialize_entry(key.name, word)?,
            }
        }
        table.end()
    }
}

impl Serialize for ModulesFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::All(module) => ModuleFile(*module).serialize(serializer),
            Self::Of(list) => serializer.collect_seq(list.iter().copied().map(ModuleFile)),
        }
    }
}

impl<'de> Deserialize<'de> for ModulesFile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ModulesVisitor;
        impl<'de> Visitor<'de> for ModulesVisitor {
            type Value = ModulesFile;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a module's name, a table with `like` and what differs, or a list of one for each sensor")
            }

            fn visit_str<E: Error>(self, name: &str) -> Result<ModulesFile, E> {
                ModuleVisitor.visit_str(name).map(ModulesFile::All)
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<ModulesFile, A::Error> {
                ModuleVisitor.visit_map(map).map(ModulesFile::All)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<ModulesFile, A::Error> {
                // No ring has more sensors; `list` compares the length with theirs.
                const MOST: usize = 64;
                let mut modules = Vec::new();
                while modules.len() < MOST {
                    match list.next_element::<ModuleFile>()? {
                        Some(ModuleFile(module)) => modules.push(module),
                        None => return Ok(ModulesFile::Of(modules)),
                    }
                }
                match list.next_element::<IgnoredAny>()? {
                    None => Ok(ModulesFile::Of(modules)),
                    Some(_) => Err(A::Error::custom("module: more than 64 modules; expected one for each sensor")),
                }
            }
        }
        deserializer.deserialize_any(ModulesVisitor)
    }
}
