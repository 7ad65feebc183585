//! The description in the form of FMI 2.0.

use crane_codegen::exchange::xml::Xml;
use crane_live::LiveCrane;
use crane_model::dyn_crane::Functions;

use super::Subject;

/// `modelDescription.xml` of a crane with its current parameters.
pub fn write_description(crane: &LiveCrane) -> String {
    let subject = Subject::new(crane);
    let name = crane.description().name.to_string();
    let mut xml = Xml::new("Units: SI, rad. Value references are places in the list of variables, from 0.");
    let mut head = vec![("fmiVersion", "2.0".to_owned()), ("guid", subject.token())];
    head.extend(subject.origin());
    head.push(("variableNamingConvention", "flat".to_owned()));
    head.push(("numberOfEventIndicators", subject.indicators().len().to_string()));
    xml.open("fmiModelDescription", &head);
    let yes = |name| (name, "true".to_owned());
    let mut common = vec![
        ("modelIdentifier", name),
        yes("canNotUseMemoryManagementFunctions"),
        yes("canGetAndSetFMUstate"),
        yes("canSerializeFMUstate"),
    ];
    if subject.can_be_integrated() {
        common.push(yes("providesDirectionalDerivative"));
        xml.leaf("ModelExchange", &[&common[..], &[yes("completedIntegratorStepNotNeeded")]].concat());
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
        let scalar = Subject::identity(variable, reference);
        let mut real = subject.attributes(variable);
        if let Some(integral) = Subject::integral(variable.source) {
            real.push(("derivative", index(subject.reference(integral))));
        }
        xml.open("ScalarVariable", &scalar);
        xml.leaf("Real", &real);
        xml.close();
    }
    xml.close();
}

fn write_structure(subject: &Subject, xml: &mut Xml) {
    xml.open("ModelStructure", &[]);
    let lists = [
        ("Outputs", subject.outputs()),
        ("Derivatives", subject.derivatives()),
        ("InitialUnknowns", subject.initial_unknowns()),
    ];
    for (name, references) in lists.into_iter().filter(|(_, references)| !references.is_empty()) {
        xml.open(name, &[]);
        for reference in references {
            xml.leaf("Unknown", &[("index", index(reference))]);
        }
        xml.close();
    }
    xml.close();
}

/// Index of a variable in the list, counted from 1.
fn index(reference: usize) -> String {
    (reference + 1).to_string()
}
