//! Lists of motors, linear drives, cylinders and pumps, and whether they can do what is needed.

use std::{f64::consts::FRAC_PI_4, path::Path};

use crane_model::{
    CoordinateKind, Description,
    results::{CylinderDuty, DriveDuty, Duties, PumpDuty},
};
use crane_page::tables::Cell;

use crate::{
    problem::{Outcome, Problem},
    screen::Console,
    sheet::Sheet,
};

/// The column with names.
const NAME: &str = "part";

/// What a list is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Turn a joint, through a gear or not.
    Motor,
    /// Move a joint along, or wind a rope.
    Linear,
    /// Cylinders.
    Cylinder,
    /// Pumps.
    Pump,
}

impl Kind {
    const ALL: [Self; 4] = [Kind::Motor, Kind::Linear, Kind::Cylinder, Kind::Pump];

    /// Its columns and their units; the first one names what the list is of.
    const fn columns(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Kind::Motor => &[
                ("torque", "N m"),
                ("rated_torque", "N m"),
                ("speed", "rad/s"),
                ("power", "W"),
                ("braking_power", "W"),
                ("ratio", "1"),
                ("efficiency", "1"),
            ],
            Kind::Linear => {
                &[("force", "N"), ("rated_force", "N"), ("speed", "m/s"), ("power", "W"), ("braking_power", "W")]
            }
            Kind::Cylinder => &[
                ("bore", "m"),
                ("rod", "m"),
                ("pressure", "Pa"),
                ("stroke", "m"),
                ("retracted", "m"),
                ("speed", "m/s"),
            ],
            Kind::Pump => &[("flow", "m³/s"), ("pressure", "Pa"), ("power", "W")],
        }
    }

    /// The word for several.
    pub const fn plural(self) -> &'static str {
        match self {
            Kind::Motor => "motors",
            Kind::Linear => "linear drives",
            Kind::Cylinder => "cylinders",
            Kind::Pump => "pumps",
        }
    }
}

/// What a part is needed for.
pub struct Need<'a> {
    /// Name of the drive, the cylinder, or the pump.
    pub name: &'a str,
    /// Of which kind the part is.
    pub kind: Kind,
    duty: Duty<'a>,
}

enum Duty<'a> {
    Drive(&'a DriveDuty),
    Cylinder(&'a CylinderDuty),
    Pump(&'a PumpDuty),
}

/// Everything that needs a part. A drive with a cylinder needs that one.
pub fn needs<'a>(duties: &'a Duties, description: &'a Description) -> Vec<Need<'a>> {
    let drives = duties.drives.iter().filter(|drive| drive.cylinder.is_none()).map(|drive| {
        let kind = if drive.kind == CoordinateKind::Rotation { Kind::Motor } else { Kind::Linear };
        Need { name: &drive.name, kind, duty: Duty::Drive(drive) }
    });
    let cylinders = duties.cylinders.iter().zip(&*description.cylinders);
    let cylinders =
        cylinders.map(|(duty, info)| Need { name: &info.name, kind: Kind::Cylinder, duty: Duty::Cylinder(duty) });
    let pump = duties.pump.iter().map(|pump| Need { name: "pump", kind: Kind::Pump, duty: Duty::Pump(pump) });
    drives.chain(cylinders).chain(pump).collect()
}

/// A list of parts.
pub struct List {
    /// What it is of.
    pub kind: Kind,
    path: String,
    sheet: Sheet,
}

/// What a part can do of what is needed.
#[derive(Clone, Debug)]
pub struct Checked {
    /// Its name.
    pub name: String,
    /// The largest part of what it can do that is used.
    pub used: f64,
    /// Of what.
    pub of: String,
    /// What it cannot do, in words.
    pub short: Vec<String>,
    /// Pressure that a cylinder needs, Pa.
    pub pressure: Option<f64>,
    /// Flow that a cylinder needs, m³/s.
    pub flow: Option<f64>,
}

impl Checked {
    /// Whether it can do everything.
    pub fn suffices(&self) -> bool {
        self.short.is_empty()
    }

    /// Among those that suffice, the most used one comes first; among the others, the one that lacks least.
    pub fn order(&self) -> f64 {
        if self.suffices() { -self.used } else { self.used }
    }

    fn new(name: &str) -> Self {
        Self { name: name.to_owned(), used: 0.0, of: String::new(), short: Vec::new(), pressure: None, flow: None }
    }

    /// Notes how much of a limit, if there is one, is needed; `shown`: a number as people read it.
    fn uses(&mut self, what: &str, needed: f64, limit: Option<f64>, shown: impl Fn(f64) -> (f64, String)) {
        let Some(limit) = limit else { return };
        if needed / limit > self.used {
            self.used = needed / limit;
            what.clone_into(&mut self.of);
        }
        self.fits(what, [needed, limit], shown);
    }

    /// Notes what is needed beyond a limit.
    fn fits(&mut self, what: &str, [needed, limit]: [f64; 2], shown: impl Fn(f64) -> (f64, String)) {
        if needed > limit {
            let ((needed, unit), (limit, _)) = (shown(needed), shown(limit));
            let [needed, limit] = [needed, limit].map(|number| Cell::Number(number).short());
            self.short.push(format!("{what} {needed} of {limit} {unit}"));
        }
    }
}

impl List {
    /// Reads a CSV file: a column `part` with names, and those of the kind, of which the first is in every row.
    ///
    /// # Errors
    /// The file cannot be read as such a list.
    pub fn read(console: &Console, path: &Path) -> Outcome<Self> {
        let help = "write a CSV table such as `part,torque [N m],speed [rpm]` for motors; with `force` it lists linear drives, with `bore` cylinders, with \
                    `flow` pumps";
        let sheet = Sheet::read(console, path, help)?;
        let is_of = |kind: &Kind| sheet.place(kind.columns()[0].0).is_some();
        let mut kinds = Kind::ALL.into_iter().filter(is_of);
        let path = path.display().to_string();
        let (Some(kind), None) = (kinds.next(), kinds.next()) else {
            return Err(Problem::usage(
                format!("{path} has none of the columns `torque`, `force`, `bore` and `flow`, or several of them"),
                help,
            ));
        };
        let known: Vec<&str> = [NAME].into_iter().chain(kind.columns().iter().map(|(name, _)| *name)).collect();
        if let Some(other) = sheet.names().find(|name| !known.contains(name)) {
            return Err(Problem::usage(
                format!("{path} has the column `{other}`, which {} do not have", kind.plural()),
                format!("their columns are {}", known.join(", ")),
            ));
        }
        if sheet.place(NAME).is_none() {
            return Err(Problem::usage(format!("{path} has no column `{NAME}`"), "name each part"));
        }
        let list = Self { kind, path, sheet };
        for row in 0..list.sheet.len() {
            list.check_row(row)?;
        }
        Ok(list)
    }

    /// Name of its file.
    pub fn name(&self) -> &str {
        &self.path
    }

    fn check_row(&self, row: usize) -> Outcome<()> {
        let key = self.kind.columns()[0].0;
        if self.number(row, key)?.is_none() {
            return Err(self.sheet.problem(row, &format!("the {key} is empty"), "write it, or leave the row out"));
        }
        for (name, _) in self.kind.columns() {
            let number = self.number(row, name)?;
            if *name == "efficiency" && number.is_some_and(|number| number > 1.0) {
                return Err(self.sheet.problem(
                    row,
                    "the efficiency is above 1",
                    "write 0.9 or `efficiency [%]` and 90",
                ));
            }
        }
        if self.kind == Kind::Cylinder && self.number(row, "rod")? >= self.number(row, "bore")? {
            return Err(self.sheet.problem(row, "the rod is not thinner than the bore", "write both diameters"));
        }
        Ok(())
    }

    /// A number of a row, in SI; `None` without the column or in an empty field.
    fn number(&self, row: usize, name: &str) -> Outcome<Option<f64>> {
        let Some(column) = self.sheet.place(name) else { return Ok(None) };
        self.sheet.number_above_zero(row, column, self.unit(name))
    }

    fn unit(&self, name: &str) -> &'static str {
        self.kind.columns().iter().find(|(column, _)| *column == name).map_or("1", |(_, unit)| unit)
    }

    /// All parts beside what is needed.
    ///
    /// # Errors
    /// Those of its numbers.
    pub fn check(&self, need: &Need<'_>) -> Outcome<Vec<Checked>> {
        (0..self.sheet.len()).map(|row| self.check_part(row, &need.duty)).collect()
    }

    fn check_part(&self, row: usize, duty: &Duty<'_>) -> Outcome<Checked> {
        let name = self.sheet.place(NAME).map_or("", |column| self.sheet.text(row, column));
        let number = |name: &str| self.number(row, name);
        let mut checked = Checked::new(name);
        let shown = |what: &str, number: f64| match self.sheet.place(what) {
            Some(column) => self.sheet.shown(column, number, self.unit(what)),
            None => (number, self.unit(what).to_owned()),
        };
        let uses = |found: &mut Checked, what: &str, needed: f64| -> Outcome<()> {
            found.uses(&what.replace('_', " "), needed, number(what)?, |number| shown(what, number));
            Ok(())
        };
        match duty {
            Duty::Drive(DriveDuty { effort, rms, rate, power, braking_power, .. }) => {
                let [ratio, efficiency] = ["ratio", "efficiency"].map(number);
                let (ratio, efficiency) = (ratio?.unwrap_or(1.0), efficiency?.unwrap_or(1.0));
                let [most, rated] =
                    if self.kind == Kind::Motor { ["torque", "rated_torque"] } else { ["force", "rated_force"] };
                uses(&mut checked, most, effort / (ratio * efficiency))?;
                uses(&mut checked, rated, rms / (ratio * efficiency))?;
                uses(&mut checked, "speed", rate * ratio)?;
                uses(&mut checked, "power", power / efficiency)?;
                uses(&mut checked, "braking_power", *braking_power)?;
            }
            Duty::Cylinder(duty) => {
                let CylinderDuty { speed, lengths: [shortest, longest], .. } = duty;
                let (bore, rod) = (number("bore")?.unwrap_or(f64::NAN), number("rod")?.unwrap_or(0.0));
                let areas = [bore * bore, bore * bore - rod * rod].map(|square| FRAC_PI_4 * square);
                let pressure = duty.pressure_with(areas);
                uses(&mut checked, "pressure", pressure)?;
                uses(&mut checked, "speed", *speed)?;
                let (stroke, retracted) = (number("stroke")?, number("retracted")?);
                let of_stroke = |number| shown("stroke", number);
                if let Some(stroke) = stroke {
                    checked.fits("stroke", [longest - shortest, stroke], of_stroke);
                }
                if let Some(retracted) = retracted.filter(|retracted| retracted > shortest) {
                    let [retracted, shortest] = [retracted, *shortest].map(|number| {
                        let (number, unit) = shown("retracted", number);
                        format!("{} {unit}", Cell::Number(number).short())
                    });
                    checked.short.push(format!("retracted {retracted} where it is {shortest} long"));
                }
                if let Some((stroke, retracted)) = stroke.zip(retracted) {
                    checked.fits("length", [*longest, retracted + stroke], of_stroke);
                }
                checked.pressure = Some(pressure);
                checked.flow = Some(duty.flow_with(areas));
            }
            Duty::Pump(PumpDuty { flow, pressure, power, .. }) => {
                uses(&mut checked, "flow", *flow)?;
                uses(&mut checked, "pressure", *pressure)?;
                uses(&mut checked, "power", *power)?;
            }
        }
        Ok(checked)
    }
}
