//! Constants that describe the crane.

use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};
use syn::{Item, parse_quote};

use super::arithmetic::{integer, literal};
use super::print::constant;
use crate::chain::{
    Attachment, BodyId, Bristle, Chain, CoordinateId, CoordinateKind, Cylinder, Drive, Event, Force, Joins, Profile,
    Side, SupportKinematics, Valve,
};

/// The sizes and the `DESCRIPTION`.
pub fn description(chain: &Chain) -> Vec<Item> {
    let n = integer(chain.coordinates.len());
    let mut items = vec![constant("Number of generalized coordinates.", "N", &quote!(usize), &quote!(#n))];
    items.push(description_constant(chain));
    items
}

fn cylinder_info(chain: &Chain, cylinder: &Cylinder) -> TokenStream {
    let [piston, annulus] = cylinder.areas().map(literal);
    let [retracted, stroke, back_pressure] = [cylinder.retracted, cylinder.stroke, cylinder.back_pressure].map(literal);
    let [of_piston, of_rod] = cylinder.hose_volumes.map(literal);
    let of_drive = chain.drive_of(cylinder);
    let [first, end] = Chain::range(&chain.spanned_by(cylinder)).map(integer);
    let (name, drive) = (text(&cylinder.name), integer(of_drive));
    let commanded = chain.drives[of_drive].opening().is_some();
    let valve = cylinder.valve.as_ref().map_or_else(|| quote!(None), |valve| valve_info(valve, commanded));
    let [max_pressure, bulk_modulus] = [cylinder.max_pressure, cylinder.bulk_modulus].map(optional);
    quote!(CylinderInfo {
        name: #name,
        drive: #drive,
        areas: [#piston, #annulus],
        spanned: [#first, #end],
        retracted: #retracted,
        stroke: #stroke,
        max_pressure: #max_pressure,
        back_pressure: #back_pressure,
        bulk_modulus: #bulk_modulus,
        hose_volumes: [#of_piston, #of_rod],
        valve: #valve
    })
}

fn valve_info(valve: &Valve, commanded: bool) -> TokenStream {
    let [flow, pressure_drop, overlap, lag] = [valve.flow, valve.pressure_drop, valve.overlap, valve.lag].map(literal);
    let [gain, feed_forward, leakage] = [valve.gain, valve.feed_forward, valve.leakage].map(literal);
    quote!(Some(ValveInfo {
        flow: #flow,
        pressure_drop: #pressure_drop,
        overlap: #overlap,
        lag: #lag,
        commanded: #commanded,
        gain: #gain,
        feed_forward: #feed_forward,
        leakage: #leakage
    }))
}

fn drive_info(drive: &Drive, defaults: &[f64]) -> TokenStream {
    let (coordinate, start) = (integer(drive.coordinate.0), literal(drive.profile.start(defaults)));
    let pieces = integer(drive.pieces().len());
    let [max_rate, max_power] = [drive.max_rate(), drive.max_power()].map(optional);
    quote!(DriveInfo {
        coordinate: #coordinate,
        start: #start,
        pieces: #pieces,
        max_rate: #max_rate,
        max_power: #max_power
    })
}

fn bristle_info((id, bristle): (CoordinateId, Bristle)) -> TokenStream {
    let coordinate = integer(id.0);
    let Bristle { coulomb, breakaway, stribeck, stiffness, damping } = bristle;
    let [coulomb, breakaway, stribeck] = [coulomb, breakaway, stribeck].map(literal);
    let [stiffness, damping] = [stiffness, damping].map(literal);
    quote!(BristleInfo {
        coordinate: #coordinate,
        coulomb: #coulomb,
        breakaway: #breakaway,
        stribeck: #stribeck,
        stiffness: #stiffness,
        damping: #damping
    })
}

fn description_constant(chain: &Chain) -> Item {
    let defaults = chain.parameter_defaults();
    let coordinates = chain.coordinates.iter().enumerate().map(|(i, c)| {
        let (name, kind, role) = (text(&c.name), kind(c.kind), role(chain, i));
        quote!(CoordinateInfo { name: #name, kind: CoordinateKind::#kind, role: CoordinateRole::#role })
    });
    let bodies = chain.bodies.iter().enumerate().map(|(p, body)| {
        let (name, link) = (text(&body.name), text(&body.link));
        let degrees = integer(chain.degrees_of_freedom(BodyId(p)));
        quote!(BodyInfo { name: #name, link: #link, degrees_of_freedom: #degrees })
    });
    let sections = chain.beams.iter().flat_map(|beam| &beam.sections).map(|section| {
        let (body, at, slides) = (integer(section.body.0), text(&section.at), section.slides.is_some());
        let side = match section.side {
            Side::Before => quote!(Before),
            Side::Both => quote!(Both),
            Side::After => quote!(After),
        };
        quote!(SectionInfo { body: #body, side: Side::#side, at: #at, slides: #slides })
    });
    let supports = chain.supports.iter().map(|support| {
        let name = text(&support.name);
        let linear = support.kinematics == SupportKinematics::Linear;
        let one_sided = support.friction.is_some();
        quote!(SupportInfo { name: #name, linear: #linear, one_sided: #one_sided })
    });
    let drives = chain.drives.iter().map(|drive| drive_info(drive, &defaults));
    let stops = chain.stopped().into_iter().map(|id| integer(id.0));
    let frictions = chain.frictions().map(|(id, _)| integer(id.0));
    let bristles = list(chain.bristles().map(bristle_info));
    let loads = chain.loads.iter().map(|load| {
        let (name, pieces) = (text(&load.name), integer(load.pieces()));
        quote!(LoadInfo { name: #name, pieces: #pieces })
    });
    let connectors = chain.connectors().iter().map(|connector| connector_info(chain, connector));
    let inputs = chain.inputs.iter().map(|input| {
        let [name, unit, about] = [&input.name, &input.unit, &input.about].map(|words| text(words));
        let default = literal(input.unless_set.start(&defaults));
        let moves = !matches!(input.unless_set, Profile::Hold(_));
        quote!(InputInfo { name: #name, unit: #unit, about: #about, default: #default, moves: #moves })
    });
    let cylinders = chain.cylinders.iter().map(|cylinder| cylinder_info(chain, cylinder));
    let pump = chain.pump.as_ref().map_or_else(
        || quote!(None),
        |pump| {
            let (max_flow, pressure, volume) = (literal(pump.max_flow), optional(pump.pressure), literal(pump.volume));
            quote!(Some(PumpInfo { max_flow: #max_flow, pressure: #pressure, volume: #volume }))
        },
    );
    let points = chain.points.iter().map(|point| text(&point.name));
    let events = list(chain.events.iter().map(event_info));
    let parameters = if chain.parameters.is_empty() { quote!(&[]) } else { quote!(&PARAMETERS) };
    let statics = chain.analyses.statics;
    let guess = chain.guess.iter().map(|&x| literal(x));
    let [coordinates, bodies, sections] = [list(coordinates), list(bodies), list(sections)];
    let [stops, frictions, loads, inputs] = [list(stops), list(frictions), list(loads), list(inputs)];
    let connectors = list(connectors);
    let [supports, drives, points, guess] = [list(supports), list(drives), list(points), list(guess)];
    let cylinders = list(cylinders);
    let [name, title, hash] = [&chain.name, &chain.title, &chain.spec_hash].map(|words| text(words));
    let (duration, step, output) = (literal(chain.run.duration), literal(chain.run.step), literal(chain.run.output));
    parse_quote! {
        #[doc = " Names, units and settings."]
        pub const DESCRIPTION: Description = Description {
            name: #name,
            title: #title,
            spec_hash: #hash,
            parameters: List::Static(#parameters),
            coordinates: #coordinates,
            bodies: #bodies,
            sections: #sections,
            supports: #supports,
            drives: #drives,
            stops: #stops,
            frictions: #frictions,
            bristles: #bristles,
            loads: #loads,
            connectors: #connectors,
            inputs: #inputs,
            cylinders: #cylinders,
            pump: #pump,
            points: #points,
            statics: #statics,
            guess: #guess,
            duration: #duration,
            step: #step,
            output: #output,
            events: #events,
        };
    }
}

fn event_info(event: &Event) -> TokenStream {
    let (name, time) = (text(&event.name), literal(event.time));
    let changes = list(event.changes.iter().map(|(id, value)| {
        let (index, value) = (integer(id.0), literal(*value));
        quote!((#index, #value))
    }));
    let joins = event.joins.map_or_else(
        || quote!(None),
        |Joins { velocity, point }| {
            let ([x, y, z], point) = (velocity.map(literal), point.map(integer));
            let point = point.map_or_else(|| quote!(None), |point| quote!(Some(#point)));
            quote!(Some(JoinsInfo { velocity: [#x, #y, #z], point: #point }))
        },
    );
    quote!(EventInfo { name: #name, time: #time, changes: #changes, joins: #joins })
}

/// Text of a description.
pub fn text(text: &str) -> TokenStream {
    quote!(Text::Static(#text))
}

/// A number that may be missing.
fn optional(number: Option<f64>) -> TokenStream {
    number.map(literal).map_or(quote!(None), |number| quote!(Some(#number)))
}

/// A list of a description.
fn list(items: impl Iterator<Item = impl ToTokens>) -> TokenStream {
    quote!(List::Static(&[#(#items),*]))
}

fn kind(kind: CoordinateKind) -> TokenStream {
    let variant = match kind {
        CoordinateKind::Translation => format_ident!("Translation"),
        CoordinateKind::Rotation => format_ident!("Rotation"),
    };
    quote!(#variant)
}

fn role(chain: &Chain, coordinate: usize) -> TokenStream {
    let role = if chain.base.iter().flatten().any(|id| id.0 == coordinate) {
        "Base"
    } else if chain.is_prescribed(CoordinateId(coordinate)) {
        "Prescribed"
    } else if chain.drives.iter().any(|d| d.coordinate.0 == coordinate) {
        "Driven"
    } else if chain.turns_by_vector(CoordinateId(coordinate)) {
        "ElementVector"
    } else if chain.is_of_element(CoordinateId(coordinate)) {
        "Element"
    } else {
        "Passive"
    };
    let role = format_ident!("{role}");
    quote!(#role)
}

fn connector_info(chain: &Chain, connector: &Force) -> TokenStream {
    let name = text(&connector.name);
    let (is_rope, is_contact) = (connector.is_rope(), connector.is_contact());
    let [first, end] = Chain::range(&chain.spanned(&connector.strain)).map(integer);
    let pieces = integer(connector.pieces());
    let line = connector.strain.line();
    let points = list(connector.strain.points().iter().map(attachment_info));
    let falls = integer(line.map_or(1, |line| line.falls as usize));
    let kind = match chain.kind_of(&connector.strain) {
        CoordinateKind::Translation => quote!(CoordinateKind::Translation),
        CoordinateKind::Rotation => quote!(CoordinateKind::Rotation),
    };
    quote!(ConnectorInfo { name: #name, points: #points, falls: #falls, kind: #kind, is_rope: #is_rope, is_contact: #is_contact, spanned: [#first, #end], pieces: #pieces })
}

/// A point of a body or of the world.
pub fn attachment_info(end: &Attachment) -> TokenStream {
    let body = if let Some(BodyId(body)) = end.body {
        let body = integer(body);
        quote!(Some(#body))
    } else {
        quote!(None)
    };
    quote!(AttachmentInfo { body: #body })
}
