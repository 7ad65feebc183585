//! The description in the form of FMI 3.0.

use crane_codegen::exchange::xml::Xml;
use crane_live::LiveCrane;
use crane_model::dyn_crane::Functions;

use super::Subject;

/// `modelDescription.xml` of a crane with its current parameters.
pub fn write_description(crane: &LiveCrane) -> String {
    let subject = Subject::new(crane);
    let mut xml = Xml::new("Units: SI, rad.");
    let mut head = vec![("fmiVersion", "3.0".to_owned()), ("instantiationToken", subject.token())];
    head.extend(subject.origin());
    head.push(("variableNamingConvention", "flat".to_owned()));
    xml.open("fmiModelDescription", &head);
    let yes = |name| (name, "true".to_owned());
    let mut common = vec![
        ("modelIdentifier", crane.description().name.to_string()),
        yes("canGetAndSetFMUState"),
        yes("canSerializeFMUState"),
    ];
    if subject.can_be_integrated() {
        common.push(yes("providesDirectionalDerivatives"));
        common.push(yes("providesAdjointDerivatives"));
        let no_completed_steps = ("needsCompletedIntegratorStep", "false".to_owned());
        xml.leaf("ModelExchange", &[&common[..], &[no_completed_steps]].concat());
    }
    xml.leaf("CoSimulation", &[&common[..], &[yes("canHandleVariableCommunicationStepSize")]].concat());
    subject.write_units(&mut xml);
    Subject::write_categories(&mut xml);
    subject.write_experiment(&mut xml);
    write_variables(&subject, &mut xml);
    write_structure(&subject, &mut xml);
    xml.finish()
}

fn write_variables(subject: &Subject, xml: &mut Xml) {
    xml.open("ModelVariables", &[]);
    for (reference, variable) in subject.variables.iter().enumerate() {
        let mut float = Subject::identity(variable, reference);
        float.extend(subject.attributes(variable));
        if let Some(integral) = Subject::integral(variable.source) {
            float.push(("derivative", subject.reference(integral).to_string()));
        }
        xml.leaf("Float64", &float);
    }
    xml.close();
}

fn write_structure(subject: &Subject, xml: &mut Xml) {
    xml.open("ModelStructure", &[]);
    let lists = [
        ("Output", subject.outputs()),
        ("ContinuousStateDerivative", subject.derivatives()),
        ("InitialUnknown", subject.initial_unknowns()),
        ("EventIndicator", subject.indicators()),
    ];
    for (name, references) in lists {
        for reference in references {
            xml.leaf(name, &[("valueReference", reference.to_string())]);
        }
    }
    xml.close();
}
