//! Tabulated factors, to compare with what is computed.

use crane_codegen::presets::{Factor, TABLE};
use crane_page::tables::{Cell, Grid};

/// The whole table.
pub fn table() -> Grid {
    let title = "Tabulated factors, without units, and where they come from; φ₂ grows with the steady speed of hoisting, γ are presets of combinations";
    let headers = ["factor", "class", "least", "greatest", "per speed [s/m]", "multiplies", "source", "edition"];
    let mut grid = Grid::new("tabulated", title, &headers);
    for Factor { symbol, of, case, values: [least, greatest], slope, source, edition } in TABLE {
        let slope = if slope > 0.0 { slope.into() } else { Cell::Empty };
        let of = of.name();
        let [symbol, case, of, source, edition] = [symbol, case, of, source, edition].map(Cell::from);
        grid.row([symbol, case, least.into(), greatest.into(), slope, of, source, edition]);
    }
    grid
}
