//! The table.

/// The table of the quantities that a crane computes, one row per function of generated code, by the [`Part`](crate::Part) to which it belongs.
/// `quantities! { consumer }` calls the macro `consumer` with it.
///
/// A row is
///
/// ```text
/// /// What else must be known, below the documentation.
/// Identifier = name(arguments) -> result rule "Documentation, with units." "Equation [source]" python(arguments; time);
/// ```
///
/// * *arguments*: `t`, `q`, `v`, accelerations `a`, right-hand side `r`, `positions` of the drives, in this order.
/// * *result*: `number`; per coordinate `vector`; over the base's coordinates `base`; n × n `matrix` and a list `[item; count]`, which are written
///   into the caller's: items are those of [`Item`](crate::Item), the count is one of [`Count`](crate::Count); `other`: everything about the
///   method is written by hand.
/// * *rule* for cranes that do not have the function: the result is `zero`, because they lack such a component; it is `required` of every crane whose
///   spec asks for the part, and NaN for others; `written`: the default is written by hand.
/// * *python*: offered by the Python package, with these arguments, the one after the semicolon optional.
#[macro_export]
macro_rules! quantities {
    ($consumer:ident) => {
        $crate::quantities! { @($consumer) }
    };
    (@($($consumer:tt)*) $([$($first:tt)*])?) => {
        $($consumer)*! { $($($first)*)?
Common {
    Transforms = transforms(q) -> [transform; bodies] required
        "Transforms T of all bodies into the world frame; translations in m."
        "T(p) = T(p−1) T̃(p) [Urbaś 2016, Eq. (3)]" python(q);
    BodySizes = body_sizes() -> [pair; bodies] required
        "Mass (kg) of every body, 0 for a frame without one, and its length (m) along x, 0 unless it is a rigid finite element or a link of a rope."
        "m, l";
    SupportPlaces = support_places() -> [vector; supports] zero
        "Where every support is attached, in the frame of the base, m."
        "r";
    SectionPlaces = section_places(q) -> [pair; sections] zero
        "Distance of every section from the beginning of its beam, and the beam's length, m. A section at a pad moves along the beam, and stays at the end of a beam that has left it."
        "x, L";
    Attachments = attachments() -> [vector; attachments] zero
        "The points of all connectors, then both ends of all joints that close loops, each in the frame of its body or of the world, m."
        "r";
    Points = points(q) -> [vector; points] zero
        "Positions of the points of interest in the world frame, m."
        "T(p) r" python(q);
    PointVelocities = point_velocities(q, v) -> [vector; points] zero
        "Velocities of the points of interest in the world frame, m/s."
        "Ṫ(p) r = ω × x + υ" python(q, v);
    /// An accelerometer at the point measures these minus the acceleration of gravity. `crane eval` takes the accelerations q̈ from the equations
    /// of motion.
    PointAccelerations = point_accelerations(q, v, a) -> [vector; points] zero
        "Accelerations of the points of interest in the world frame, m/s²."
        "J q̈ + J̇ q̇ = R (a + α × r + ω × (ω × r))" python(q, v, a);
    /// The forces of cylinders with a valve depend on their pressures and are not included. Those of rigid drives are, as the efforts with which
    /// `A q̈ = e + f` also holds in the rows of the coordinates that they prescribe; in an open chain.
    Forces = forces(t, q, v) -> vector zero
        "Generalized forces of everything except inertia and gravity, N and N m."
        "f_s + f_l + t_dr and viscous joints [Urbaś 2016, Eq. (23)]" python(q, v; t);
    SupportForces = support_forces(q, v) -> vector zero
        "Generalized forces of the supports, N and N m."
        "−Jᵀ (s e + d ė) [Urbaś 2016, Eq. (18)]" python(q, v);
    ElementForces = element_forces(q, v) -> vector zero
        "Generalized forces of the springs and dampers between rigid elements, N m."
        "−S q̃ − D q̃̇ [Urbaś 2016, Eq. (15)]" python(q, v);
    DriveForces = drive_forces(t, q, v) -> vector zero
        "Generalized forces of the drives, N and N m."
        "s (q_dr − q) + d (q̇_dr − q̇) [Urbaś 2016, Eqs. (20)–(21)]" python(q, v; t);
    JointDamperForces = joint_damper_forces(v) -> vector zero
        "Generalized forces of viscous damping in passive joints, N and N m."
        "−d q̇" python(v);
    StopForces = stop_forces(q, v) -> vector zero
        "Generalized forces of the end stops, N and N m."
        "−k δ max(0, 1 + a δ̇)" python(q, v);
    FrictionForces = friction_forces(v) -> vector zero
        "Generalized forces of joint friction, N and N m."
        "−(F_c + (F_b − F_c) exp(−(q̇/v_s)²)) tanh(q̇/v₀) − b q̇" python(v);
    LoadForces = load_forces(t, q) -> vector zero
        "Generalized forces of the loads applied from outside, N and N m."
        "F · Ω_j x + M · ω_j" python(q; t);
    /// A description has the number of intervals of each load, [`LoadInfo::pieces`](crate::LoadInfo::pieces).
    LoadPieces = load_pieces() -> [pair; load_pieces] zero
        "Start and end of the intervals in which the scales of loads are smooth, load by load, s."
        "t_begin, t_end";
    ConnectorForces = connector_forces(t, q, v) -> vector zero
        "Generalized forces of connectors, N and N m."
        "−Jᵀ F" python(q, v; t);
    ConnectorLengths = connector_lengths(q, v) -> [pair; connectors] zero
        "Length ℓ (m) of every connector, and its rate ℓ̇ (m/s)."
        "|p₂ − p₁|, J q̇" python(q, v);
    ConnectorTensions = connector_tensions(t, q, v) -> [tension; connectors] zero
        "Force F of every connector (N), positive where it pulls, and its derivatives ∂F/∂ℓ (N/m) and ∂F/∂ℓ̇ (N s/m)."
        "k (ℓ − ℓ₀) + d ℓ̇ − P; k σ max(0, 1 + a σ̇)" python(q, v; t);
    ConnectorJacobians = connector_jacobians(q) -> [row; connectors] zero
        "How the length of every connector changes with the coordinates, one row per connector, m/rad and 1."
        "J = ∂ℓ/∂q" python(q);
    /// A description has the number of intervals of each connector, [`ConnectorInfo::pieces`](crate::ConnectorInfo::pieces).
    WinchPieces = winch_pieces() -> [pair; winch_pieces] zero
        "Start and end of the intervals in which winches move smoothly, connector by connector, s."
        "t_begin, t_end";
    LoopStates = loop_states(q, v) -> [vector; loop_equations] zero
        "Every equation of the loop joints: its gap φ (m, and 1 for the direction of a pin), the rate of φ, and the part of its second \
         rate that does not depend on accelerations."
        "φ, J q̇, J̇ q̇" python(q, v);
    LoopJacobians = loop_jacobians(q) -> [row; loop_equations] zero
        "How the gaps of the loop joints change with the coordinates, one row per equation."
        "J = ∂φ/∂q" python(q);
    SupportReactions = support_reactions(q, v) -> [vector; supports] zero
        "Forces of the supports on the crane in the world frame, N."
        "−s e − d ė [Urbaś 2016, Eq. (16)]" python(q, v);
    SupportGaps = support_gaps(q, v) -> [pair; supports] zero
        "How far one-sided supports are above the ground, m, negative where they are pressed in, and its rate, m/s; 0 for others."
        "e_z, ė_z [Urbaś 2016, Eq. (16)]" python(q, v);
    /// Zeros for a crane without one-sided supports, as for the next four.
    SupportElongations = support_elongations(q) -> [vector; supports] zero
        "How far every support is from where the spec puts it, in the world frame, m."
        "e [Urbaś 2016, Eq. (16)]" python(q);
    SupportJacobians = support_jacobians(q) -> [row; support_axes] zero
        "How the elongations of the supports change with the coordinates: three rows per support; m/rad and 1."
        "J = ∂e/∂q" python(q);
    SupportStiffnesses = support_stiffnesses() -> [vector; supports] zero
        "Stiffness of every support along the world's axes, N/m."
        "s";
    SupportDampings = support_dampings() -> [vector; supports] zero
        "Damping of every support along the world's axes, N s/m."
        "d";
    SupportGrips = support_grips(q, v) -> [vector; supports] zero
        "Pressing force of one-sided supports, the lateral force up to which they stick, and the one that keeps them where the spec puts them, N; 0 for others."
        "N, μ N, |F|" python(q, v);
    /// NaN where the linkage of a cylinder cannot be assembled.
    CylinderStates = cylinder_states(q, v) -> [vector; cylinders] zero
        "Length of every cylinder, m, its rate, m/s, and its derivative with respect to the joint's coordinate, m/rad or m/m."
        "ℓ, ℓ̇, ∂ℓ/∂q_j" python(q, v);
    /// A cylinder with a valve that pushes with F exerts the generalized forces `F ∂ℓ/∂q`. Zeros for a crane without valves.
    CylinderJacobians = cylinder_jacobians(q) -> [row; cylinders] zero
        "Derivatives of the length of every cylinder with respect to the coordinates, m/m and m/rad."
        "∂ℓ/∂q" python(q);
    DriveMotions = drive_motions(t) -> [pair; drives] zero
        "Prescribed position q_dr (m, rad) and rate q̇_dr (m/s, rad/s) of every drive."
        "q_dr(t), q̇_dr(t)" python(t);
    ValveOpenings = valve_openings(t) -> [pair; drives] zero
        "Command of the valve of every drive over time, −1 to 1, and its rate, 1/s; zeros without one."
        "u*(t), u̇*(t)" python(t);
    /// Zeros for a crane without limits.
    DriveLimits = drive_limits(t, q, v) -> [pair; drives] zero
        "Maximum effort of every drive, N m or N, 0 without a limit, and its stiffness at the state, N m/rad or N/m."
        "M, −∂t_dr/∂q" python(t, q, v);
    PrescribedMotions = prescribed_motions(t) -> other written
        "Position q_dr (m, rad) and rate q̇_dr (m/s, rad/s) of every coordinate that a rigid drive prescribes."
        "q_dr(t), q̇_dr(t)";
    /// A description has the number of intervals of each drive, [`DriveInfo::pieces`](crate::DriveInfo::pieces).
    DrivePieces = drive_pieces() -> [pair; drive_pieces] zero
        "Start and end of the intervals in which the motions and valve commands of drives are smooth, drive by drive, s."
        "t_begin, t_end";
    GravityEnergy = gravity_energy(q) -> number required
        "Potential energy of gravity, zero at the world's origin, J."
        "E_g = −Σ γ · ∫ x dm [Urbaś 2016, Eq. (6)]" python(q);
    SupportEnergy = support_energy(q) -> number zero
        "Energy of the supports' springs, J."
        "½ Σ s e² [Urbaś 2016, Eqs. (16)–(17)]" python(q);
    ElementEnergy = element_energy(q) -> number zero
        "Energy of the springs between rigid elements, J."
        "½ q̃ᵀ S q̃ [Urbaś 2016, Eq. (14)]" python(q);
    DriveEnergy = drive_energy(t, q) -> number zero
        "Energy of the drives' springs, J."
        "½ Σ s (q_dr − q)² [Urbaś 2016, Eq. (19)]" python(q; t);
    StopEnergy = stop_energy(q) -> number zero
        "Energy of the end stops, J."
        "½ Σ k δ²" python(q);
    ConnectorEnergy = connector_energy(t, q) -> number zero
        "Energy of connectors, J."
        "½ Σ k (ℓ − ℓ₀)² − P (ℓ − ℓ₀)" python(q; t);
    DrivePower = drive_power(t, q, v) -> number zero
        "Power of the prescribed motions, W."
        "Σ t_dr q̇_dr" python(q, v; t);
    LoadPower = load_power(t, q, v) -> number zero
        "Power that the loads applied from outside put in, W."
        "Σ F · ẋ + M · ω" python(q, v; t);
    WinchPower = winch_power(t, q, v) -> number zero
        "Power that winches put in, W."
        "−Σ F ℓ̇₀" python(q, v; t);
    Dissipation = dissipation(t, q, v) -> number zero
        "Power that all dampers dissipate, W."
        "2R [Urbaś 2016, Eqs. (14), (17), (19)]" python(q, v; t);
}
Dynamics {
    /// In O(n): A is never formed. The forces of cylinders with a valve are not included. Of the open chain, except in Python.
    ForwardDynamics = forward_dynamics(t, q, v) -> vector written
        "Accelerations q̈, m/s² and rad/s²."
        "A q̈ = e + f [Urbaś 2016, Eq. (23)], by articulated bodies" python(q, v; t);
    SolveMass = solve_mass(q, r) -> vector written
        "Solution x of `A x = r`; r in N and N m, x in m/s² and rad/s²."
        "A x = r, by articulated bodies at rest";
    /// For all equations of the loop joints in one pass, so that accelerations with closed loops take one call. J̇ q̇ is filled up with zeros to
    /// whole rows. Cylinders with a valve, as in `forward_dynamics`. Zero rows for a crane without loops.
    LoopDynamics = loop_dynamics(t, q, v) -> [row; loop_rows] zero
        "Accelerations of the open chain, and what closes its loops: J̇ q̇ of their equations, their rows J, and A⁻¹ Jᵀ, one row per equation."
        "q̈ of the open chain, J̇ q̇, J, A⁻¹ Jᵀ";
    /// Symmetric positive definite.
    MassMatrix = mass_matrix(q) -> matrix required
        "Mass matrix A; kg, kg m and kg m²."
        "a_ij = tr(Ω_i W_max(i,j) Ω_jᵀ) [Urbaś 2016, Eq. (5)]" python(q);
    MassMatrixAndBias = mass_matrix_and_bias(q, v) -> other written
        "Mass matrix A, its lower triangle, and bias e; kg, kg m, kg m², N, N m."
        "A, e [Urbaś 2016, Eqs. (5), (9)]";
    /// They are on the right-hand side of `A q̈ = e + f`: the negative of the bias force C of Featherstone, of Pinocchio's `nle` and of
    /// MuJoCo's `qfrc_bias`, which are on the left-hand side.
    Bias = bias(q, v) -> vector required
        "Bias e: velocity and gravity forces, N and N m."
        "e = −(h + g), h_i + g_i = tr(Ω_i Σ T H B̄ᵀ) [Urbaś 2016, Eqs. (5), (7), (9)]" python(q, v);
    KineticEnergy = kinetic_energy(q, v) -> number required
        "Kinetic energy, J."
        "E_k = ½ Σ tr(Ṫ H Ṫᵀ) [Urbaś 2016, Eq. (4)]" python(q, v);
}
Systems {
    Factorise = factorise(q, added_inertia, base) -> other written
        "Factors of `A + D̂` for [`solve`]: D̂ has `added_inertia` on its diagonal, and `base` in the base's rows and columns."
        "A + D̂, by articulated bodies at rest";
    Solve = solve(f, r) -> other written
        "Solution x of `(A + D̂) x = r` from the factors of `A + D̂`."
        "(A + D̂) x = r";
    /// What a drive or another force would have to add: positive where it pushes towards larger coordinates; zero in all coordinates that
    /// move freely with a = q̈. For coordinates that rigid drives prescribe, f contains no force of these drives, and r is the effort that they
    /// need. The forces of cylinders with a valve, of bristles and of joints that close loops are not part of f.
    DynamicResidual = dynamic_residual(t, q, v, a) -> vector written
        "Generalized forces r that a motion requires beyond those that act, N and N m."
        "r = A a − e − f, by Newton and Euler" python(q, v, a; t);
}
StepMatrices {
    JointStiffnessAndDamping = joint_stiffness_and_damping() -> [pair; coordinates] required
        "Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) on single coordinates, without those of the base."
        "s, d [Urbaś 2016, Eqs. (14), (19)]";
    NonlinearStiffnessAndDamping = nonlinear_stiffness_and_damping(t, q, v) -> [pair; coordinates] zero
        "Stiffness (N/m, N m/rad) and damping (N s/m, N m s/rad) of end stops and friction on single coordinates."
        "∂F/∂q, max(0, ∂F/∂q̇)";
    BaseStiffness = base_stiffness(q, v) -> base zero
        "Stiffness of supports and drives over the base's coordinates; N/m, N and N m."
        "Σ Jᵀ diag(s, d) J [Urbaś 2016, Eq. (18)]";
    BaseDamping = base_damping(q, v) -> base zero
        "Damping of supports, drives and joints over the base's coordinates; N s/m, N s and N m s."
        "Σ Jᵀ diag(s, d) J [Urbaś 2016, Eq. (18)]";
}
Statics {
    /// In Python, the drives are where they are at times t.
    StaticResidual = static_residual(t, q, positions) -> vector required
        "Gradient of the potential energy with the drives at given positions, zero in equilibrium; N and N m."
        "∂E_p/∂q [Urbaś 2016, Eqs. (7), (15), (18), (20)]" python(q; t);
    /// Positive definite if the equilibrium is stable. A prescribed coordinate, whose residual is 0, has 1 on the diagonal and zeros elsewhere
    /// in its row and column. In Python, the drives are where they are at times t.
    TangentStiffness = tangent_stiffness(t, q, positions) -> matrix required
        "Tangent stiffness K: derivative of the residual, its symmetric part; N/m, N and N m."
        "∂²E_p/∂q∂q" python(q; t);
    /// ℓ₀ is the length of a cylinder with the joint at the position of its drive and straight beams, and k the stiffness of the drive over
    /// the squared lever arm there. In Python, the drives are where they are at times t.
    DriveForcesAtRest = drive_forces_at_rest(t, q, positions) -> vector zero
        "Generalized forces of the drives that hold the crane at rest at given positions, N and N m."
        "s (q_dr − q) [Urbaś 2016, Eq. (20)]; of rigid drives ∂E_p/∂q_j; of cylinders with a valve k (ℓ₀ − ℓ) ∂ℓ/∂q" python(q; t);
}
Modes {
    Linearise = linearise(q) -> other written
        "Mass matrix A, tangent stiffness K and damping matrix D of small motions about a pose at rest at t = 0."
        "A δq̈ + D δq̇ + K δq = 0";
}
InternalForces {
    /// In the frame of each cut, about its origin. Inertia forces, weights, loads and the forces of connectors attached to it count: a joint or
    /// a section transmits what no connector carries past it, and supports act only on the base. The forces of cylinders with a valve are not
    /// included, see [`cylinder_wrenches`](Self::cylinder_wrenches), nor those of joints that close loops, see
    /// [`loop_wrenches`](Self::loop_wrenches). At the ground it is the load on the foundation or on the supports. In a
    /// section of a beam it is `N, Qy, Qz` and `Mx, My, Mz`: a positive N is tension; Mx, My and Mz have the signs of the deformations that
    /// they cause, φ, θ and ψ.
    InternalForces = internal_forces(t, q, v, a) -> [wrench; cuts] required
        "Force (N) and moment (N m) that the part beyond a cut exerts on the part before it, cut by cut."
        "Σ F − Σ ∫ (ẍ − γ) dm, Σ (M + r × F) − Σ ∫ r × (ẍ − γ) dm over everything beyond, by Newton and Euler";
    /// Zeros for a crane without valves.
    CylinderWrenches = cylinder_wrenches(q) -> [wrench; cylinder_cuts] zero
        "Force (1) and moment (m) at every cut, cut by cut, due to each cylinder while it pushes with 1 N."
        "Σ g, Σ r × g over everything beyond";
    ConnectorWrenches = connector_wrenches(q) -> [wrench; connector_cuts] zero
        "Force (1) and moment (m) at every cut, cut by cut, due to each connector between two bodies while it pulls with 1 N."
        "Σ e, Σ r × e over everything beyond";
    LoopWrenches = loop_wrenches(q) -> [wrench; loop_cuts] zero
        "Force (1) and moment (m) at every cut, cut by cut, due to each equation of the loop joints while it transmits 1 N or 1 N m."
        "Σ g, Σ r × g over everything beyond";
    SupportPositions = support_positions(q) -> [vector; supports] zero
        "Positions of the supports' attachment points in the world frame, m."
        "T(1) r_E" python(q);
    SectionModuli = section_moduli() -> [moduli; sections] zero
        "Section properties for the stresses of beams: areas (m²), moduli (m³), allowable stress (Pa); 0 where unknown."
        "A, W_y, W_z, W_t, A_y, A_z; yield stress over safety factor";
}
Derivatives {
    TransformDerivatives = transform_derivatives(q) -> [transform; derivatives] required
        "Derivatives ∂T/∂q_j of every body, for all coordinates j that move it; 1, m, 1/m."
        "∂T/∂q_j = Ω_j T" python(q);
    TransformSecondDerivatives = transform_second_derivatives(q) -> [transform; second_derivatives] required
        "Second derivatives ∂²T/∂q_m∂q_n of every body, for all pairs m ≤ n of the coordinates that move it."
        "∂²T/∂q_m∂q_n = Ω_m Ω_n T";
}
MotionDerivatives {
    /// For each point the rows x, y and z: the velocities of the points are J q̇.
    PointJacobians = point_jacobians(q) -> [row; point_axes] zero
        "Derivatives J of the points' positions with respect to the coordinates; m/rad and 1."
        "J = ∂(T(p) r)/∂q_j = Ω_j T(p) r" python(q);
    /// The torque of robotics, with inertia and gravity alone: what all forces together must be. `crane eval` takes the accelerations q̈ from
    /// the equations of motion.
    InverseDynamics = inverse_dynamics(q, v, a) -> vector required
        "Generalized forces that a motion requires in total, N and N m."
        "A a − e = A a + h + g, by Newton and Euler" python(q, v, a);
    /// Row i and column j of each matrix: the change of `r_i` with `q_j`, and with `q̇_j`. At rest ∂r/∂q is the tangent stiffness, and ∂r/∂v
    /// the damping matrix.
    DynamicResidualDerivatives = dynamic_residual_derivatives(t, q, v, a) -> [row; residual_rows] written
        "Derivatives ∂r/∂q (N/m, N, N m) and ∂r/∂v (N s/m, N s, N m s) of the residual r = A a − e − f."
        "Ω_i · (Ω̈_j W + 2 Ω̇_j G + Ω_j × F) − ∂f_i/∂q_j, 2 Ω_i · (Ω̇_j W + Ω_j G) − ∂f_i/∂q̇_j" python(q, v, a; t);
    /// Row i and column j of each matrix: the change of `f_i` with `q_j`, and with `q̇_j`. f is that of `dynamic_residual`: without the efforts of
    /// rigid drives, which `forces` has.
    ForceDerivatives = force_derivatives(t, q, v) -> [row; residual_rows] required
        "Derivatives ∂f/∂q (N/m, N, N m) and ∂f/∂v (N s/m, N s, N m s) of the generalized forces f, without efforts of rigid drives."
        "∂f_i/∂q_j, ∂f_i/∂q̇_j" python(q, v; t);
    /// The runtime multiplies them in loops, see [`rt::derivatives`](crate::rt::derivatives).
    ResidualFactors = residual_factors(q, v, a) -> [row; residual_factors] required
        "What the derivatives of the generalized forces that a motion requires are products of, coordinate by coordinate."
        "Ω, Ω̇, V, V̇ − γ, W, G, F";
    /// Of a prescribed coordinate κ, λ and 1/D are zero. The runtime multiplies them in loops, see [`rt::derivatives`](crate::rt::derivatives).
    MassFactors = mass_factors(q) -> [row; mass_factors] required
        "Factors of the inverse mass matrix, coordinate by coordinate: axes, articulated forces and moments, offsets, reciprocal inertias."
        "A⁻¹ = Lᵀ D⁻¹ L [Featherstone 2008, chapter 7]";
    /// Zero in rows and columns of coordinates that rigid drives prescribe. Of the open chain.
    InverseMassMatrix = inverse_mass_matrix(q) -> matrix written
        "Inverse A⁻¹ of the mass matrix: accelerations per generalized force; 1/kg, 1/(kg m) and 1/(kg m²)."
        "A⁻¹ = Lᵀ D⁻¹ L, by articulated bodies" python(q);
    /// About a moving state, δq̈ = ∂q̈/∂q δq + ∂q̈/∂v δq̇ + A⁻¹ δτ. For coordinates that rigid drives prescribe the rows are zero, and so are their
    /// columns of A⁻¹. Of the open chain.
    ForwardDynamicsDerivatives = forward_dynamics_derivatives(t, q, v) -> other written
        "Derivatives ∂q̈/∂q, ∂q̈/∂v and ∂q̈/∂τ = A⁻¹ of the accelerations q̈ of `forward_dynamics`."
        "−A⁻¹ ∂r/∂q, −A⁻¹ ∂r/∂v, A⁻¹, at a = q̈";
}
        }
    };
}

/// Extent of each index of a result, each after a comma.
#[doc(hidden)]
#[macro_export]
macro_rules! axes {
    (number) => { "" };
    (vector) => { ", n" };
    (matrix) => { ", n, n" };
    (base) => { ", 6, 6" };
    (other) => { "" };
    // Also those of coordinates that do not move a body.
    ([transform; derivatives]) => { ", bodies, n, 4, 4" };
    ([pair; coordinates]) => { ", n, 2" };
    ([row; point_axes]) => { ", points, 3, n" };
    ([row; support_axes]) => { ", supports, 3, n" };
    ([row; residual_rows]) => { ", 2, n, n" };
    ([row; residual_factors]) => { ", 66, n" };
    ([row; mass_factors]) => { ", 13, n" };
    ([$item:ident; $count:ident]) => { concat!(", ", stringify!($count), $crate::axes!(@ $item)) };
    (@ vector) => { ", 3" };
    (@ pair) => { ", 2" };
    (@ row) => { ", n" };
    (@ tension) => { ", 3" };
    (@ wrench) => { ", 6" };
    (@ moduli) => { ", 8" };
    (@ transform) => { ", 4, 4" };
}
