//! The one table of diagnostic codes.
//!
//! A row is a variant, the name that programs and people see, a title, the explanation that `pebo-gen explain CODE`
//! prints, and the section of the paper, where there is one. Each has an input that provokes it, with its mend, in
//! `examples`, which tests run. To add a code is to add a row and an example; a code that was released keeps its name.

macro_rules! codes {
    ($($(#[$group:meta])* $variant:ident $name:literal $title:literal $explanation:literal $(=> $paper:literal)?)*) => {
        /// The kind of mistake or finding of a diagnostic.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        #[cfg_attr(feature = "yaml", derive(serde::Serialize))]
        pub enum Code {
            $(
                #[doc = concat!("`", $name, "`: ", $title, ".")]
                #[cfg_attr(feature = "yaml", serde(rename = $name))]
                $variant,
            )*
        }

        impl Code {
            /// Every code, in the order of the table.
            pub const ALL: &[Self] = &[$(Self::$variant),*];

            /// The name, as in `error[unknown-key]`.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name),* }
            }

            /// The title: a few words.
            pub fn title(self) -> &'static str {
                match self { $(Self::$variant => $title),* }
            }

            /// The explanation: a paragraph or two.
            pub fn explanation(self) -> &'static str {
                match self { $(Self::$variant => $explanation),* }
            }

            /// An input that provokes it, with its mend as a comment: a model file, a module of Rust, or after `$ ` a
            /// command of a shell.
            pub fn example(self) -> &'static str {
                match self { $(Self::$variant => include_str!(concat!("examples/", $name, ".txt"))),* }
            }

            /// The section in Ortega et al. 2015, where there is one.
            pub fn paper(self) -> Option<&'static str> {
                match self { $(Self::$variant => None$(.or(Some($paper)))?),* }
            }

            /// Tests whether it means that something could not be worked out, and not that the input is wrong.
            pub fn is_open(self) -> bool {
                matches!(self, Self::LimitReached | Self::ClassUnresolved)
            }

            /// The code of that name.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|code| code.name() == name)
            }
        }
    };
}

codes! {
    // The command.

    LimitReached "limit-reached" "the limit on time or memory was reached"
        "A command has 10 seconds for each model, or what `--limit` says, and 512 MB (in proportion where the limit \
         is longer). The message names the phase in which the limit was reached; what was not decided by then is \
         undecided. Time is counted in steps of work first, so that the verdict is the same on any machine that is \
         not very slow. Formulas with fewer functions, parameters with values, and shared parts with names under \
         define take less time."

    FigureFormat "figure-format" "a figure is asked for in a format that is not written"
        "Figures are SVG: a drawing that can be scaled, and that browsers and text processors show. The ending of the file's \
         name says so. Other programs make other formats of it, as `rsvg-convert figure.svg -o figure.png`."

    // Files.

    CannotRead "cannot-read" "a file cannot be read"
        "The operating system refused to open or read the file; the message has its reason. Check the path and the \
         permissions."
    CannotWrite "cannot-write" "a file cannot be written"
        "The operating system refused to create or write the file; the message has its reason. A file is written \
         whole or not at all: an older file of that name is unchanged."
    NotText "not-text" "a file is not UTF-8 text"
        "A model file is YAML text encoded in UTF-8. This file has a byte sequence that is not UTF-8: it is binary, \
         or it was saved in another encoding."
    FileTooLarge "file-too-large" "a file is larger than a model can be"
        "Model files are limited to one megabyte. Models written by hand have a few kilobytes."

    // YAML.

    EmptyFile "empty-file" "a model file has no content"
        "The file is empty, or holds only comments. A model is a map with at least the keys model, x, y and f_x, \
         and f_y or g_y for an output."
    YamlSyntax "yaml-syntax" "the text is not YAML"
        "The YAML parser stopped here. Frequent causes: a tab in the indentation; a missing space after a colon; a \
         formula that begins with a character that means something to YAML (* & ! { [ % @ ` | >) and needs quotes; a \
         bracket or quote that is never closed; a formula with a comma inside { } or [ ], which needs quotes too."
    YamlFeature "yaml-feature" "a feature of YAML that model files cannot use"
        "Anchors (&name), aliases (*name), tags (!name), merge keys, directives (%) and several documents in one file \
         are refused, so that every value stands where it is used. A formula that begins with * & or ! needs quotes."
    NestedTooDeep "nested-too-deep" "lists or maps are nested too deep"
        "No part of a model file nests more than a handful of levels."
    TooManyValues "too-many-values" "the file has too many values"
        "The number of names, numbers and formulas in one model file is limited, so that checking it ends in time."
    DuplicateKey "duplicate-key" "a key occurs twice in one map"
        "YAML leaves open which of two equal keys counts. Remove one of them."

    // The shape of a model file.

    UnknownKey "unknown-key" "a key that model files do not have"
        "The help lists the keys that are valid in this place. Keys are written exactly so: case matters."
    MissingKey "missing-key" "a required key is absent"
        "A model needs model, x, y and f_x, and for a search for phi the rate of an output under f_y, its value under g_y, \
         or an identity; some of the nested maps have required keys of their own, and phi_left needs phi."
    WrongShape "wrong-shape" "a value has the wrong shape"
        "A key expects a name, a number, a formula, a list or a map, and found another of these."
    WrongChoice "wrong-choice" "a word that is none of the choices"
        "The key accepts only the words that the help lists."
    SettingConflict "setting-conflict" "settings of the observer that do not go together"
        "Each estimator has settings of its own: gain for gradient; gain, normalisation for normalised-gradient; \
         covariance, forgetting, process_noise for least-squares; gain, regressor_gain, forgetting for drem, and clip, period \
         besides for finite-time-drem; gain, regressor_gain for gradient-drem; gain, covariance, forgetting for \
         least-squares-drem. All have bounds, and rebase where the regression is affine in z. The regression goes through a filter \
         or through a window, not both, and hold is how these join samples. bounds are those of an estimator that is chosen. What is known of sensors, start and disturbance stands in place of all these: \
         gains are derived of it, and beside it only covariance in place of start, and process_noise in place of \
         disturbance, may be written. form: output needs a regression of rates that is affine in z."
    EmptyList "empty-list" "a list must not be empty"
        "A model has at least one unmeasured state, one output and one component of phi."
    ClassConflict "class-conflict" "a class beside keys that the class gives"
        "A model written by class (lti, mechanical or electromechanical) has its equations f_x and f_y and its transform \
         phi from the class. These keys, or a second class, cannot be given as well."
        => "Sections 4, 5.1 and 5.2"
    ClassUnresolved "class-unresolved" "the matrices of a class could not be worked out"
        "Expanding a class inverts matrices exactly. Here that was not possible; the message names the obstacle. \
         Simpler formulas, or parameters with values, may avoid it."
        => "Sections 4, 5.1 and 5.2"
    NotSymmetric "not-symmetric" "a matrix that must be symmetric is not"
        "The inertia matrix M and the inductance matrix L are those of an energy, hence symmetric. The message names a \
         pair of entries that differ."
        => "Sections 5.1 and 5.2"
    SingularMatrix "singular-matrix" "a matrix has no inverse anywhere"
        "The inertia matrix M, the frame T and the inductance matrix L are inverted. This one has determinant zero \
         whatever the positions are."
        => "Sections 5.1 and 5.2"

    // Models in plain Rust.

    MissingItem "missing-item" "a struct or a function of the model is absent"
        "A module under #[pebo_model] has at least the structs X and Y, whose fields are the unmeasured states and \
         the measured outputs, and the function f_x. It may also have the structs U (inputs) and W \
         (unmeasured signals that are not estimated), the functions f_y, g_y, phi, phi_left and identities, and \
         constants, which are the parameters."
    UnsupportedRust "unsupported-rust" "Rust that has no meaning in a model"
        "The functions of a model are read as formulas: + - * /, the functions of floating-point numbers, let, \
         fields, indices, and calls of other functions of the module. Branches, loops, closures, macros and \
         assignments are not formulas. The reader accepts nothing that would mean something else than what the \
         compiled function computes."

    // Names.

    InvalidName "invalid-name" "a text that is not a name"
        "A name has ASCII letters, digits and underscores, and does not begin with a digit. Greek letters are spelled \
         out, as lambda_m."
    ReservedName "reserved-name" "a name that the generator needs itself"
        "z1, z2, .. are the coordinates, chi1, .. the dynamic extension, theta1, .. the unknown parameters, xi1, .. \
         and Psi11, .. those of the generalised cascade (Psi1_1, .. of more than nine components); t is time where \
         a simulation is given. A declared quantity of that name would make formulas ambiguous. All other names are \
         free, also E, I, S, e, pi and sin."
    DuplicateName "duplicate-name" "a name is declared twice"
        "Parameters, states, outputs, inputs, unmeasured signals and definitions share one space of names."
    CircularDefinition "circular-definition" "definitions that depend on one another in a circle"
        "The definitions under define may stand in any order, but one of them must come first: a definition that \
         uses itself, perhaps through others, has no meaning. The message names those of the circle; define one of \
         them by declared quantities."
    UnknownName "unknown-name" "a name that is not declared"
        "A formula uses a name that is not declared in the model, or not known in this place. Names are declared under \
         parameters, x, y, u, w or define; case matters."
    MissingEntry "missing-entry" "a map lacks an entry for a declared name"
        "Every unmeasured state needs its rate, its time derivative, under f_x."
    UnknownEntry "unknown-entry" "a map has an entry for a name that does not belong there"
        "The entries of f_x and phi_left are for states x, those of f_y and g_y for outputs y, those of control for inputs u."

    // Numbers.

    MalformedNumber "malformed-number" "a text that is not a number"
        "A number is written with decimal digits, an optional point and an optional exponent, as 12, 0.5 or 22e-6. It \
         is read exactly: 0.1 is one tenth."
    NumberTooLarge "number-too-large" "a number is out of range"
        "Numbers have at most 400 digits and an exponent between -308 and 308: beyond that the emitted code could not \
         hold them."
    NumberOutOfRange "number-out-of-range" "a setting has an impossible value"
        "Durations, steps, gains and filter frequencies are positive; start times ascend."

    // Formulas.

    EmptyFormula "empty-formula" "a formula is missing"
        "A formula was expected and nothing is there. Write 0 for zero."
    UnexpectedCharacter "unexpected-character" "a character that formulas do not have"
        "Formulas have names, numbers, + - * / ^ (or **), parentheses and commas between arguments."
    UnexpectedToken "unexpected-token" "a formula continues in an unexpected way"
        "The parser read a formula up to here and cannot make sense of what follows."
    UnclosedParenthesis "unclosed-parenthesis" "a parenthesis is not closed"
        "In a model file, a comma inside { } or [ ] ends a formula that is not quoted: write \"atan2(a, b)\" there."
    ImplicitMultiplication "implicit-multiplication" "two factors without an operator"
        "Multiplication is written: 2*x, not 2 x."
    UnknownFunction "unknown-function" "a function that does not exist"
        "A name followed by an opening parenthesis is a call; a product is written with *. The message of the error \
         lists the functions that there are."
    ArgumentCount "argument-count" "a function with the wrong number of arguments"
        "The message says how many the function takes: most take one, as sin(q); atan2 takes two, as atan2(y, x)."
    MisplacedEstimate "misplaced-estimate" "hat() where there is no estimate"
        "hat(x) is the observer's estimate of the state x. It has a meaning in the control law, in the definitions, \
         baselines and panels of a simulation, and nowhere else."
        => "Section 2.4, Corollary 1"
    ComparisonExpected "comparison-expected" "an assumption without a comparison"
        "An assumption compares formulas with < <= > >= or !=, as 0 < d < 1."
    FormulaTooDeep "formula-too-deep" "a formula is nested too deep"
        "Formulas are limited to 200 levels of operators, calls and parentheses. A sum has few levels, however many terms \
         it has; a product of n factors has n. Name parts of the formula under define."
    FormulaTooLarge "formula-too-large" "a formula is too large"
        "Formulas are limited in length, and powers of powers in their total degree. Name parts of the formula under \
         define."
    ExponentTooLarge "exponent-too-large" "an exponent is too large"
        "Constant exponents lie between -64 and 64: the algebra expands integer powers exactly."

    // Meaning.

    MisplacedName "misplaced-name" "a formula depends on what its place does not allow"
        "The transform is a function of x and y, the left inverse one of z and y, a period one of parameters, the value of \
         an output under g_y one of x, u and the other outputs. A formula \
         that depends on anything else, perhaps through a definition, cannot stand there."
        => "Section 2.2, Assumption 1"
    DivisionByZero "division-by-zero" "a formula divides by zero"
        "A denominator is zero whatever the values of the names in it are, so the formula has no value anywhere."
    NoRealValue "no-real-value" "a formula has no real value"
        "The argument of a function is a constant outside of the domain of the function: the logarithm of a number \
         that is not positive, the root of a negative number, the inverse sine of a number beyond 1."
    PeriodNotPositive "period-not-positive" "a period that is not known to be positive"
        "The period of an angle is a positive constant, as 2*pi or 2*pi/n_p. If the period is made of parameters, \
         the signs of their values or an assumption must show that it is positive, because the left inverse is \
         proved for all parameters with these signs."
    ContradictoryAssumptions "contradictory-assumptions" "assumptions that cannot hold together"
        "No values satisfy the assumptions shown, or the model's own parameters violate one of them, so that a \
         claim would say nothing. Where this is not certain, but no values were found at which all assumptions hold \
         and all formulas have values, the claims are undecided."
    MissingRate "missing-rate" "a rate is needed that the model does not give"
        "The transform phi uses an output whose rate the model does not give. The rate of phi along the plant, \
         which must be h(y, u), then cannot be computed. Give the output's rate under f_y. The entries of f_x and \
         f_y are time derivatives; an equation for the value of an output, as V = E - R*i, stands under g_y, and \
         its rate follows from it where it holds no input."
        => "Section 2.2, Assumption 1 (ii)"

    // Claims.

    IdentityRefuted "identity-refuted" "an identity holds nowhere, or is not invariant along the plant"
        "The claims are about trajectories on which the identities hold. This identity has no real solution, or its \
         derivative along the plant is not zero at a point where the identities hold; the witness is such a point. \
         Either the identity or a rate is wrong."
    IdentityUndecided "identity-undecided" "the invariance of an identity is neither proved nor refuted"
        "The claims are about trajectories on which the identities hold. No values were found at which they hold, \
         or it could not be decided whether this identity is invariant along the plant. Values are found where \
         an identity changes its sign: write `a - b` rather than its square. Formulas are reduced by it if it can \
         be solved for one of its names: the name occurs to the first or second power, or in one power alone, with \
         a factor that is never zero."
    TransformNotFound "transform-not-found" "no transform was found"
        "The model has no phi, and the search found none whose claims are all proved. The notes say what came nearest and \
         why it was refused: a transform of some states, or one that would be accepted with the signs of states assumed, or \
         with another state measured. `pebo-gen solve MODEL` lists the candidates and what was tried. Measure another signal, \
         assume the signs of what is positive, or write a phi of your own."
        => "Section 2.2, Assumption 1"
    CascadeRefuted "cascade-refuted" "the rate of phi depends on unmeasured states"
        "Claim C1: along the plant, the rate of phi must be a function of outputs and inputs alone, or for the \
         generalised cascade an affine function of phi with such coefficients; `class: pebo` in a model asks for \
         the first. The message shows the residual that remains, and points at which its value differs for the same \
         y, u and parameters. Change phi; the help proposes a phi where one was found."
        => "Section 2.2, Assumption 1 (ii)"
    CascadeUndecided "cascade-undecided" "the cascade claim is neither proved nor refuted"
        "Claim C1 could not be decided; the obstacle names the expression that the algebra does not cover. Nothing is \
         emitted without a proof."
        => "Section 2.2, Assumption 1 (ii)"
    LeftInverseRefuted "left-inverse-refuted" "phi_left does not invert phi"
        "Claim C2: phi_left(phi(x, y), y) = x. The witness is a point whose state phi_left does not return. If the \
         claim holds only up to a period, say so under angles; if only in a part of the state space, under assume."
        => "Section 2.2, Assumption 1 (i)"
    LeftInverseUndecided "left-inverse-undecided" "the left inverse is neither proved nor refuted"
        "Claim C2 could not be decided; the obstacle names what the algebra does not cover. An assumption on signs \
         often decides roots."
        => "Section 2.2, Assumption 1 (i)"
    LeftInverseUnderivable "left-inverse-underivable" "no left inverse was found"
        "phi_left is absent and could not be derived from phi. Give it under phi_left; if phi does not determine x, \
         no left inverse exists."
        => "Section 2.2, Assumption 1 (i)"
    RegressionNonlinear "regression-nonlinear" "the outputs do not give a linear regression"
        "Claim C3: the rate of an output must be linear in the unknown parameters theta, or in functions of them \
         that can be listed. Another phi, or an identity for a static regression, may help; with `regression: local` \
         an observer takes the equations to first order at its estimate. The entries of f_x and \
         f_y are time derivatives: an equation for the value of an output, as V = E - R*i, stands under g_y."
        => "Section 2.2, Proposition 1, and Section 2.3"
    UnknownUpToTurns "unknown-up-to-turns" "theta is determined only up to whole turns"
        "The rates of the outputs depend on theta through sine and cosine, from which atan2 gives it up to whole turns. A \
         state that moves by its period needs no more: declare it under angles. Any other state is ambiguous: an estimate \
         that starts near another multiple stays there."
        => "Section 5.2"
    RegressionUndecided "regression-undecided" "the regression is neither proved nor refuted"
        "Claim C3 could not be decided; the obstacle names what the algebra does not cover."
        => "Section 2.2, Proposition 1, and Section 2.3"
    NeverIdentifiable "never-identifiable" "the regressor never determines theta"
        "Claim C4: the outputs do not depend on a direction of theta, shown in the message, whatever the input is. \
         Measure another signal, or choose a phi with fewer components."
        => "Section 2.3, Assumption 2"
    IdentifiabilityUndecided "identifiability-undecided" "identifiability is neither proved nor refuted"
        "Claim C4 could not be decided; the obstacle says which rank is unknown."
        => "Section 2.3, Assumption 2"

    // Code.

    CannotEmit "cannot-emit" "an accepted model cannot be written as code"
        "Every claim is proved, but the code is not there. Most often a number of the model is too large or too small \
         for the floating-point type: f32 holds magnitudes from 1.2e-38 to 3.4e38. Units in which quantities are near 1 \
         help accuracy too. What was written is read back and proved equal to what was derived; should that fail, it \
         is a defect of pebo-gen, and no code is better than wrong code."
    LosesDigits "loses-digits" "the model's formulas lose digits at a place, and so does the code"
        "The error of an emitted function, measured at places of the domain, is more than a hundred times what rounding of \
         its arguments causes, and the model's own formulas lose as many digits there: they subtract what is nearly \
         equal, or pass beyond the numbers that the floating-point type holds. The code is there all the same, and its \
         documentation names each place. Write the formula in a form that keeps the digits, assume what keeps the plant \
         away from the place, choose units in which quantities are near 1, or take f64."

    // Simulation.

    SimulationMissing "simulation-missing" "a model that says nothing about simulation"
        "To simulate, the model file needs a section `simulation` with duration, step, the states at the start and a \
         control law for each input. A section `observer` is not needed: without it, its numbers are assumed."
    SimulationIncomplete "simulation-incomplete" "a simulation lacks something that it needs"
        "Every parameter needs a value, every state and output a start and a rate, every input a control law, every \
         unmeasured signal w its values over time under signals, and the observer its gains and its filter where some of them \
         are written. What known numbers come to may depend on where the plant operates, which initial, control and step say."
    SimulationTooLong "simulation-too-long" "a simulation has too many samples"
        "The number of samples, duration over step, and the size of the table that is written are limited, so that a \
         wrong power of ten does not make a run of days."
    SimulationUnsupported "simulation-unsupported" "a simulation that this version cannot run"
        "The simulator runs the observer in one of a few fixed sizes, and the estimators of the runtime library. The \
         message says what the simulator does not have. The emitted code has no such limit."
    NotConverged "not-converged" "an estimate did not settle in a simulation or on a recording"
        "An estimate has settled when its error stays below a hundredth of the largest magnitude that the state has in the \
         run. The notes say what was seen: samples that the observer refused, data that did not determine the unknown \
         (excitation), an error that still falls, or one that rests because the plant and its sensors are not what the \
         model says. The run itself is as it was asked for, and its files are written."
    NumbersContradicted "numbers-contradicted" "samples contradict the numbers of an observer"
        "An observer of known numbers expects each sample, and knows by how much that will be off. The normalised square of \
         the difference, the innovation, is 1 on average where numbers, model and plant agree. Above 5 the plant does more \
         than its model says, or sensors scatter more than `sensors`; below 0.2 they scatter less. The standard errors that \
         follow from the numbers are then not those of the estimates, and none is given."
    SimulationFailed "simulation-failed" "a simulation stopped before its end"
        "The closed loop left the domain of a formula, grew beyond all bounds, or is too stiff for the explicit \
         integrator. The message says when and where. A shorter step, other gains or another start may help."

    // Recorded data.

    RecordingIncomplete "recording-incomplete" "a recording does not say what the observer needs"
        "A replay needs the time of each row, or the period between them, and a value of every output and input. The \
         column of a signal's own name is that signal; for any other, the section `recording` of the model has a formula \
         in columns and parameters. In formulas a column is called by its name with an underscore for what cannot be in \
         a name: `Channel A (V)` is Channel_A_V."
    RecordingMalformed "recording-malformed" "a recording is not a table of numbers"
        "A recording is CSV text: a line with the names of the columns, then a row of numbers for each sample, parted by \
         commas, semicolons or tabs. Lines that begin with # are comments, and a row of units may stand below the names. A \
         number may have a decimal comma where commas part nothing; a time may be a date, as 2026-11-27T10:00:00.25, and \
         is then counted from the first row. The message has line and column of the first cell that is none of these. A \
         cell that is empty, NaN or infinite is no mistake: it is a fault of a sensor, which is counted."
}
