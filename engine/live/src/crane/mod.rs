//! A crane from a chain that implements what all algorithms need.

mod evaluation;
mod fleet;
mod loop_stiffness;
mod model;
pub mod rows;
mod systems;

use std::fmt;
use std::sync::{Arc, Mutex, TryLockError};

use crane_codegen::chain::{Chain, Input};
use crane_codegen::program::FunctionId;
use crane_codegen::{Diagnostics, SourceFile, compile};
use crane_model::dyn_crane::{DynCrane, Functions};
use crane_model::rt::derivatives::Link;
use crane_model::{Description, LoopJointInfo, ParameterError, StageInfo, fill_links};

use crate::inputs::{Inputs, slots_of};
use crate::library::Library;
pub use evaluation::Evaluation;

/// A crane of any number of coordinates that is ready without rustc.
///
/// Functions are derived when they are first called. Clones share them, and have their own parameters.
pub struct LiveCrane {
    library: Arc<Library>,
    description: Description,
    loop_joints: Vec<LoopJointInfo>,
    stages: Vec<StageInfo>,
    parameters: Vec<f64>,
    /// The numbers of the inputs, which a motion of this crane may share.
    inputs: Arc<Inputs>,
    /// Workspaces for calls, one per function, kept from the last call; cranes that differ only in their inputs share them.
    rooms: Rooms,
}

/// A workspace for each function, once it was called: a call holds its lock, and has a workspace of its own while another thread does.
type Rooms = Arc<[Mutex<Option<Evaluation<f64>>>; FunctionId::COUNT]>;

impl LiveCrane {
    /// Coordinates of the largest crane: `solve` takes 49,144 of the 65,536 registers of narrow bytecode at 3,013.
    pub const MOST_COORDINATES: usize = Chain::MOST_COORDINATES;
    /// Coordinates of the largest crane that has derivatives of the residual and of accelerations; those of a larger one are NaN.
    pub const MOST_COORDINATES_OF_DERIVATIVES: usize = Chain::MOST_COORDINATES_OF_DERIVATIVES;

    /// The crane of a spec.
    ///
    /// # Errors
    /// All mistakes of the spec at once.
    pub fn from_spec(source: &SourceFile) -> Result<Self, Diagnostics> {
        compile::load(source).map(Self::new)
    }

    /// The crane of a chain, with the parameters of its spec.
    #[must_use]
    pub fn new(chain: Chain) -> Self {
        let (description, loop_joints) = (chain.description(), chain.loop_joint_infos());
        let stages = chain.stage_infos();
        let parameters = chain.parameter_defaults();
        let inputs = Arc::new(not_set(&chain));
        let library = Arc::new(Library::new(chain));
        Self { library, description, loop_joints, stages, parameters, inputs, rooms: no_rooms() }
    }

    /// The same crane, whose inputs are those of this one also when they change.
    pub(crate) fn sharing_inputs(&self) -> Self {
        Self { inputs: Arc::clone(&self.inputs), ..self.clone() }
    }

    /// The same crane, its parameters and inputs as they are, with a factor of its weight and of all loads as one more parameter, which is 1; and the
    /// index of this parameter.
    #[must_use]
    pub fn with_load_factor(&self) -> (Self, usize) {
        let (chain, index) = self.chain().with_load_factor();
        let parameters = self.parameters.iter().copied().chain([1.0]).collect();
        (Self { parameters, inputs: Arc::clone(&self.inputs), ..Self::new(chain) }, index)
    }

    /// The chain from which it was made.
    #[must_use]
    pub fn chain(&self) -> &Chain {
        self.library.chain()
    }

    /// Lends the workspace of a function, with the inputs as they are now.
    fn with_evaluation<R>(&self, id: FunctionId, compute: impl FnOnce(&mut Evaluation<f64>) -> R) -> R {
        let kept = match self.rooms[id as usize].try_lock() {
            Ok(kept) => Some(kept),
            Err(TryLockError::Poisoned(kept)) => Some(kept.into_inner()),
            // Another thread is in it.
            Err(TryLockError::WouldBlock) => None,
        };
        let (mut kept, mut own) = (kept, None);
        let room = kept.as_deref_mut().unwrap_or(&mut own);
        let evaluation = room.get_or_insert_with(|| Evaluation::new(self, id));
        evaluation.set_inputs(self.inputs.numbers());
        compute(evaluation)
    }

    /// The live parameters, in the order of the description.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        &self.parameters
    }

    /// Acceleration of gravity in the world frame, m/s².
    #[must_use]
    pub fn gravity(&self) -> [f64; 3] {
        self.chain().gravity.each_ref().map(|value| value.at(&self.parameters))
    }

    /// Value of an input at t = 0 where it is not set.
    #[must_use]
    pub fn input_start(&self, index: usize) -> f64 {
        self.chain().inputs[index].unless_set.start(&self.parameters)
    }

    /// The numbers of the inputs.
    pub(crate) fn inputs(&self) -> &Arc<Inputs> {
        &self.inputs
    }

    /// The same crane with other inputs, in the order of the description: those not set follow the spec. Nothing is computed
    /// again, and the workspaces are shared.
    #[must_use]
    pub fn with_inputs(&self, values: &[Option<f64>]) -> Self {
        let inputs = Arc::new(not_set(self.chain()));
        for (index, value) in values.iter().enumerate() {
            inputs.set(index, slots_of(*value));
        }
        let Self { library, description, loop_joints, stages, parameters, rooms, .. } = self;
        Self {
            library: Arc::clone(library),
            description: description.clone(),
            loop_joints: loop_joints.clone(),
            stages: stages.clone(),
            parameters: parameters.clone(),
            inputs,
            rooms: Arc::clone(rooms),
        }
    }

    /// Its functions, which all its clones share.
    pub(crate) fn library(&self) -> Arc<Library> {
        Arc::clone(&self.library)
    }

    /// Makes the machine code of a function now, instead of after some hundred calls, so that no later call takes longer than
    /// others; returns whether there is any: the crane needs the function, and this processor and system have machine code.
    pub fn compile(&self, id: FunctionId) -> bool {
        self.library.routine(id).is_some_and(|routine| routine.compile::<f64>().is_some())
    }

    /// Whether all parameters together may have these values.
    ///
    /// # Errors
    /// The rule of the spec language that they break.
    pub fn check(&self, parameters: &[f64]) -> Result<(), ParameterError> {
        for (info, value) in self.description.parameters.iter().zip(parameters) {
            info.check(*value)?;
        }
        match self.chain().broken_relation(parameters) {
            Some(relation) => Err(ParameterError { given: None, refusal: relation.refusal.clone() }),
            None => Ok(()),
        }
    }

    /// All parameters, the first of them with these values.
    fn with_first(&self, values: &[f64]) -> Result<Vec<f64>, ParameterError> {
        let mut parameters = self.parameters.clone();
        copy(values, &mut parameters);
        self.check(&parameters)?;
        Ok(parameters)
    }

    /// What its coordinates are attached to.
    pub(crate) fn links(&self) -> Vec<Link> {
        let mut links = vec![Link::default(); self.size()];
        fill_links(&self.description, self.parents(), &mut links);
        links
    }

    /// Whether the crane has too many coordinates for a function.
    pub(crate) fn is_too_large_for(&self, id: FunctionId) -> bool {
        let grows = matches!(
            id,
            FunctionId::DynamicResidualDerivatives
                | FunctionId::ForwardDynamicsDerivatives
                | FunctionId::ForceDerivatives
                | FunctionId::InverseMassMatrix
        );
        grows && self.chain().coordinates.len() > Self::MOST_COORDINATES_OF_DERIVATIVES
    }
}

fn no_rooms() -> Rooms {
    Arc::new(std::array::from_fn(|_| Mutex::new(None)))
}

/// The inputs if none is set.
fn not_set(chain: &Chain) -> Inputs {
    Inputs::new(chain.inputs.iter().map(|_| Input::NOT_SET))
}

fn copy(results: &[f64], out: &mut [f64]) {
    out.iter_mut().zip(results).for_each(|(place, result)| *place = *result);
}

impl Clone for LiveCrane {
    fn clone(&self) -> Self {
        Self {
            library: Arc::clone(&self.library),
            description: self.description.clone(),
            loop_joints: self.loop_joints.clone(),
            stages: self.stages.clone(),
            parameters: self.parameters.clone(),
            inputs: Arc::new(self.inputs.copy()),
            rooms: no_rooms(),
        }
    }
}

impl fmt::Debug for LiveCrane {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut debug = f.debug_struct("LiveCrane");
        debug.field("name", &self.description.name).field("parameters", &self.parameters).finish_non_exhaustive()
    }
}
