//! What a crane consists of: names, units and numbers that do not change.

use crane_codegen::chain::{CoordinateId, NamedFrame, NamedJoint};
use crane_live::LiveCrane;
use crane_model::dyn_crane::DynCrane;
use crane_model::{BodyInfo, ConnectorInfo, Cut, Description, SectionInfo};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::crane::Crane;
use crate::types::Info;

#[pymethods]
impl Crane {
    /// Coordinates, bodies, drives, supports, points and parameters: names, units and descriptions.
    #[getter(info)]
    fn describe<'py>(&self, py: Python<'py>) -> PyResult<Info<'py>> {
        let crane: &dyn DynCrane = &self.live;
        let description = crane.description();
        let all = PyDict::new(py);
        let list = |rows: Vec<Bound<'py, PyDict>>| PyList::new(py, rows);
        let mut rows = Vec::new();
        for info in &description.coordinates {
            let row = PyDict::new(py);
            row.set_item("name", &*info.name)?;
            row.set_item("unit", info.kind.unit())?;
            row.set_item("force_unit", info.kind.force_unit())?;
            row.set_item("role", info.role.name())?;
            rows.push(row);
        }
        all.set_item("coordinates", list(std::mem::take(&mut rows))?)?;
        all.set_item("bodies", describe_bodies(py, &self.live)?)?;
        for (info, [start, _]) in description.drives.iter().zip(crane.drive_motions_at(0.0)) {
            let coordinate = &description.coordinates[info.coordinate];
            let row = PyDict::new(py);
            row.set_item("coordinate", &*coordinate.name)?;
            row.set_item("index", info.coordinate)?;
            row.set_item("unit", coordinate.kind.force_unit())?;
            row.set_item("start", start)?;
            rows.push(row);
        }
        all.set_item("drives", list(std::mem::take(&mut rows))?)?;
        for (info, place) in description.supports.iter().zip(crane.support_places_at()) {
            let row = PyDict::new(py);
            row.set_item("name", &*info.name)?;
            row.set_item("position", place.as_slice().to_vec())?;
            row.set_item("one_sided", info.one_sided)?;
            rows.push(row);
        }
        all.set_item("supports", list(std::mem::take(&mut rows))?)?;
        for info in &description.cylinders {
            let coordinate = &description.coordinates[description.drives[info.drive].coordinate];
            let row = PyDict::new(py);
            row.set_item("name", &*info.name)?;
            row.set_item("coordinate", &*coordinate.name)?;
            row.set_item("areas", info.areas.to_vec())?;
            row.set_item("retracted", info.retracted)?;
            row.set_item("stroke", info.stroke)?;
            rows.push(row);
        }
        all.set_item("cylinders", list(std::mem::take(&mut rows))?)?;
        all.set_item("connectors", describe_connectors(py, description)?)?;
        for info in &description.parameters {
            let row = PyDict::new(py);
            row.set_item("name", &*info.name)?;
            row.set_item("unit", &*info.unit)?;
            row.set_item("about", &*info.about)?;
            row.set_item("default", info.default)?;
            rows.push(row);
        }
        all.set_item("parameters", list(std::mem::take(&mut rows))?)?;
        for (index, info) in description.inputs.iter().enumerate() {
            let row = PyDict::new(py);
            row.set_item("name", &*info.name)?;
            row.set_item("unit", &*info.unit)?;
            row.set_item("about", &*info.about)?;
            row.set_item("default", self.live.input_start(index))?;
            row.set_item("moves", info.default.is_none())?;
            rows.push(row);
        }
        all.set_item("inputs", list(std::mem::take(&mut rows))?)?;
        all.set_item("frames", describe_frames(py, &self.live)?)?;
        all.set_item("joints", describe_joints(py, &self.live)?)?;
        let places = crane.section_places_at(&vec![0.0; crane.size()]);
        let place_of = |section: usize| (!description.sections[section].slides).then(|| places[section]);
        for cut in description.cuts() {
            let section = cut.section().map(|section| &description.sections[section]);
            let (kind, body) = match cut {
                Cut::Ground => ("ground", None),
                Cut::Joint { body } => ("joint", Some(body)),
                Cut::Body { body, section: None } => ("link", Some(body)),
                Cut::Body { .. } | Cut::Inside { .. } => ("section", section.map(|section| section.body)),
            };
            let row = PyDict::new(py);
            row.set_item("kind", kind)?;
            row.set_item("link", body.map(|body| &*description.bodies[body].link))?;
            row.set_item("x", cut.section().map(place_of))?;
            row.set_item("place", section.map(SectionInfo::location))?;
            rows.push(row);
        }
        all.set_item("cuts", list(std::mem::take(&mut rows))?)?;
        for (index, section) in description.sections.iter().enumerate() {
            let row = PyDict::new(py);
            row.set_item("beam", &*description.bodies[section.body].link)?;
            row.set_item("x", place_of(index))?;
            row.set_item("place", section.location())?;
            rows.push(row);
        }
        all.set_item("sections", list(rows)?)?;
        all.set_item("points", description.points.iter().map(|point| &**point).collect::<Vec<&str>>())?;
        all.set_item("run", (description.duration, description.step, description.output))?;
        Ok(all.into())
    }
}

/// Frames that the spec names.
fn describe_frames<'py>(py: Python<'py>, live: &LiveCrane) -> PyResult<Bound<'py, PyList>> {
    let bodies = &(live as &dyn DynCrane).description().bodies;
    let describe = |frame: &NamedFrame| {
        let row = PyDict::new(py);
        row.set_item("name", &frame.name)?;
        row.set_item("link", frame.body.map(|body| &*bodies[body.0].link))?;
        Ok(row)
    };
    PyList::new(py, live.chain().frames.iter().map(describe).collect::<PyResult<Vec<_>>>()?)
}

/// Joints that the spec names.
fn describe_joints<'py>(py: Python<'py>, live: &LiveCrane) -> PyResult<Bound<'py, PyList>> {
    let coordinates = &live.chain().coordinates;
    let describe = |joint: &NamedJoint| {
        let row = PyDict::new(py);
        row.set_item("name", &joint.name)?;
        row.set_item("coordinate", joint.coordinate.map(|CoordinateId(index)| &*coordinates[index].name))?;
        row.set_item("at", joint.at)?;
        Ok(row)
    };
    PyList::new(py, live.chain().joints.iter().map(describe).collect::<PyResult<Vec<_>>>()?)
}

/// Springs, ropes and couplings, one dictionary each.
fn describe_connectors<'py>(py: Python<'py>, description: &Description) -> PyResult<Bound<'py, PyList>> {
    let describe = |info: &ConnectorInfo| -> PyResult<Bound<'py, PyDict>> {
        let row = PyDict::new(py);
        row.set_item("name", &*info.name)?;
        row.set_item("rope", info.is_rope)?;
        row.set_item("max_tension", info.max_tension)?;
        row.set_item("contact", info.is_contact)?;
        row.set_item("unit", info.kind.unit())?;
        Ok(row)
    };
    PyList::new(py, description.connectors.iter().map(describe).collect::<PyResult<Vec<_>>>()?)
}

/// Bodies, with what carries each and which coordinates move it.
fn describe_bodies<'py>(py: Python<'py>, crane: &dyn DynCrane) -> PyResult<Bound<'py, PyList>> {
    let (tree, sizes) = (crane.tree(), crane.body_sizes_at());
    let describe = |(body, info): (usize, &BodyInfo)| {
        let row = PyDict::new(py);
        row.set_item("name", &*info.name)?;
        row.set_item("link", &*info.link)?;
        let [mass, length] = sizes[body];
        row.set_item("mass", mass)?;
        row.set_item("length", length)?;
        row.set_item("degrees_of_freedom", info.degrees_of_freedom)?;
        row.set_item("parent", tree.parent(body))?;
        row.set_item("coordinates", tree.coordinates(body))?;
        Ok(row)
    };
    let rows: PyResult<Vec<_>> = crane.description().bodies.iter().enumerate().map(describe).collect();
    PyList::new(py, rows?)
}
