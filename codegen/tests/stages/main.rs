//! The compiler, stage by stage: what it reads, expands, derives and draws.

mod any_bytes;
mod beam_parts;
mod changes;
mod cost;
mod documentation;
mod expansion;
mod internal_forces;
mod parameters;
mod presets;
mod sections;
mod shipped_specs;
mod table;
mod units;
