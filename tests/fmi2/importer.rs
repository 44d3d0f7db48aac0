//! The shared library as an importer sees it: loaded at run time, called through C pointers.

use libloading::Library;
use std::cell::RefCell;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::path::PathBuf;
use std::sync::LazyLock;
use wheelrail::fmi2::types::{CallbackFunctions, LoggerCallback};
use wheelrail::fmi2::variables::{Variable, variables};

pub use wheelrail::parameters::ContactModel::{self, Line, Patch};

pub const OK: c_int = 0;
pub const WARNING: c_int = 1;
pub const DISCARD: c_int = 2;
pub const ERROR: c_int = 3;

pub type Component = *mut c_void;
pub type Handle = *mut c_void;

macro_rules! api {
    ($($field:ident = $symbol:ident($($argument:ty),*) $(-> $result:ty)?;)*) => {
        /// The functions of fmi2Functions.h for co-simulation.
        #[allow(non_snake_case)]
        pub struct Api {
            $(pub $field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
            _library: Library,
        }

        /// Their names.
        pub const FUNCTIONS: &[&str] = &[$(stringify!($symbol)),*];

        impl Api {
            /// Loads the library that `cargo test` has built beside the test.
            pub fn load() -> Api {
                // SAFETY: loading runs no code of ours; each symbol has the signature of the standard.
                unsafe {
                    let library = Library::new(library_path()).expect("the cdylib is beside the test");
                    Api {
                        $($field: *library.get(concat!(stringify!($symbol), "\0").as_bytes()).expect(stringify!($symbol)),)*
                        _library: library,
                    }
                }
            }
        }
    };
}

api! {
    types_platform = fmi2GetTypesPlatform() -> *const c_char;
    version = fmi2GetVersion() -> *const c_char;
    set_debug_logging = fmi2SetDebugLogging(Component, c_int, usize, *const *const c_char) -> c_int;
    instantiate = fmi2Instantiate(*const c_char, c_int, *const c_char, *const c_char, *const CallbackFunctions, c_int, c_int) -> Component;
    free_instance = fmi2FreeInstance(Component);
    setup_experiment = fmi2SetupExperiment(Component, c_int, f64, f64, c_int, f64) -> c_int;
    enter_initialization = fmi2EnterInitializationMode(Component) -> c_int;
    exit_initialization = fmi2ExitInitializationMode(Component) -> c_int;
    terminate = fmi2Terminate(Component) -> c_int;
    reset = fmi2Reset(Component) -> c_int;
    get_real = fmi2GetReal(Component, *const u32, usize, *mut f64) -> c_int;
    get_integer = fmi2GetInteger(Component, *const u32, usize, *mut c_int) -> c_int;
    get_boolean = fmi2GetBoolean(Component, *const u32, usize, *mut c_int) -> c_int;
    get_string = fmi2GetString(Component, *const u32, usize, *mut *const c_char) -> c_int;
    set_real = fmi2SetReal(Component, *const u32, usize, *const f64) -> c_int;
    set_integer = fmi2SetInteger(Component, *const u32, usize, *const c_int) -> c_int;
    set_boolean = fmi2SetBoolean(Component, *const u32, usize, *const c_int) -> c_int;
    set_string = fmi2SetString(Component, *const u32, usize, *const *const c_char) -> c_int;
    get_state = fmi2GetFMUstate(Component, *mut Handle) -> c_int;
    set_state = fmi2SetFMUstate(Component, Handle) -> c_int;
    free_state = fmi2FreeFMUstate(Component, *mut Handle) -> c_int;
    serialized_size = fmi2SerializedFMUstateSize(Component, Handle, *mut usize) -> c_int;
    serialize = fmi2SerializeFMUstate(Component, Handle, *mut c_char, usize) -> c_int;
    deserialize = fmi2DeSerializeFMUstate(Component, *const c_char, usize, *mut Handle) -> c_int;
    directional_derivative = fmi2GetDirectionalDerivative(Component, *const u32, usize, *const u32, usize, *const f64, *mut f64) -> c_int;
    set_input_derivatives = fmi2SetRealInputDerivatives(Component, *const u32, usize, *const c_int, *const f64) -> c_int;
    get_output_derivatives = fmi2GetRealOutputDerivatives(Component, *const u32, usize, *const c_int, *mut f64) -> c_int;
    do_step = fmi2DoStep(Component, f64, f64, c_int) -> c_int;
    cancel_step = fmi2CancelStep(Component) -> c_int;
    get_status = fmi2GetStatus(Component, c_int, *mut c_int) -> c_int;
    get_real_status = fmi2GetRealStatus(Component, c_int, *mut f64) -> c_int;
    get_integer_status = fmi2GetIntegerStatus(Component, c_int, *mut c_int) -> c_int;
    get_boolean_status = fmi2GetBooleanStatus(Component, c_int, *mut c_int) -> c_int;
    get_string_status = fmi2GetStringStatus(Component, c_int, *mut *const c_char) -> c_int;
}

/// `cargo test` leaves the cdylib in `target/<profile>/deps`, beside the test.
pub fn library_path() -> PathBuf {
    let name = format!(
        "{}wheelrail{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    let test = std::env::current_exe().expect("the test has a path");
    test.with_file_name(name)
}

/// Whether the library is in the memory of this process. A thread-local value with a destructor would keep it there after it
/// was closed, until the thread ends: the system counts the destructors that are still to be called (glibc 2.18 and above;
/// an older one would crash then).
#[cfg(target_os = "linux")]
pub fn is_mapped() -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").expect("maps");
    maps.lines()
        .any(|line| line.ends_with(&*library_path().to_string_lossy()))
}

/// One message at the logger.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    pub instance_name: String,
    pub status: c_int,
    pub category: String,
    pub format: String,
    pub text: String,
}

/// What an importer hands over as component environment: collects the messages.
pub type Journal = RefCell<Vec<Message>>;

/// The logger is variadic in C. Where arguments are passed in registers, as here, one that is declared with one more
/// argument receives the first variadic one.
unsafe extern "C" fn collect(
    environment: *mut c_void,
    instance_name: *const c_char,
    status: c_int,
    category: *const c_char,
    format: *const c_char,
    text: *const c_char,
) {
    let string = |pointer: *const c_char| {
        // SAFETY: the library hands over strings ended by zero.
        unsafe { CStr::from_ptr(pointer) }.to_str().expect("UTF-8").to_owned()
    };
    // SAFETY: ended by zero; whatever bytes the importer gave.
    let instance_name = unsafe { CStr::from_ptr(instance_name) }.to_string_lossy().into_owned();
    // SAFETY: the environment is the journal of the client, which outlives its instance.
    let journal = unsafe { &*environment.cast::<Journal>() };
    journal.borrow_mut().push(Message {
        instance_name,
        status,
        category: string(category),
        format: string(format),
        text: string(text),
    });
}

/// Callbacks that write into a journal.
pub fn callbacks(journal: &Journal) -> CallbackFunctions {
    type Collector =
        unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char);
    CallbackFunctions {
        // SAFETY: see `collect`.
        logger: Some(unsafe { std::mem::transmute::<Collector, LoggerCallback>(collect as Collector) }),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: (&raw const *journal).cast_mut().cast(),
    }
}

/// Takes a test once with each contact model. The last one that a failure prints is where it failed.
#[track_caller]
pub fn with_each_contact_model(test: impl Fn(&Api, ContactModel)) {
    let api = Api::load();
    for contact in ContactModel::ALL.iter().copied() {
        println!("{contact:?}");
        test(&api, contact);
    }
}

/// Parameters of a contact model with a grid so coarse that tests are quick.
pub fn coarse(contact: ContactModel) -> &'static [(&'static str, c_int)] {
    match contact {
        Line => &[("contact_nodes", 25), ("depth_nodes", 17)],
        Patch => &[
            ("contact_model", 2),
            ("patch_nodes", 14),
            ("patch_strips", 7),
            ("depth_nodes", 17),
        ],
    }
}

/// Lateral and spin motion, where a contact model takes it: creepages, and the speeds that they make at 10 m/s.
pub fn sideways(contact: ContactModel) -> &'static [(&'static str, f64)] {
    match contact {
        Line => &[],
        Patch => &[
            ("lateral_creepage", 0.001),
            ("spin_creepage", 0.3),
            ("lateral_speed", 0.01),
            ("spin_rate", 3.0),
        ],
    }
}

/// An instance with its journal; calls take slices and names.
pub struct Client<'a> {
    pub api: &'a Api,
    pub component: Component,
    pub journal: Box<Journal>,
    /// The contact model that [`Client::make_coarse`] chooses.
    pub contact: ContactModel,
}

impl Drop for Client<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is freed once.
        unsafe { (self.api.free_instance)(self.component) }
    }
}

/// The GUID of the library.
pub fn guid() -> CString {
    CString::new(wheelrail::fmi2::GUID).expect("no zero")
}

impl<'a> Client<'a> {
    /// In *instantiated*, with logging off.
    pub fn new(api: &'a Api) -> Client<'a> {
        Client::with_logging(api, false)
    }

    pub fn with_logging(api: &'a Api, on: bool) -> Client<'a> {
        let journal = Box::<Journal>::default();
        let callbacks = callbacks(&journal);
        let guid = guid();
        // SAFETY: all pointers are valid during the call, the journal longer than the instance.
        let component = unsafe {
            (api.instantiate)(
                c"wheel".as_ptr(),
                1,
                guid.as_ptr(),
                c"file:///tmp/resources".as_ptr(),
                &callbacks,
                0,
                c_int::from(on),
            )
        };
        assert!(!component.is_null(), "{:?}", journal.borrow());
        Client {
            api,
            component,
            journal,
            contact: Line,
        }
    }

    /// In *instantiated*, with a coarse grid of a contact model.
    pub fn coarse(api: &'a Api, contact: ContactModel) -> Client<'a> {
        let mut client = Client::new(api);
        client.contact = contact;
        client.make_coarse();
        client
    }

    /// In *initializationMode*, with a coarse grid of a contact model.
    pub fn initializing(api: &'a Api, contact: ContactModel) -> Client<'a> {
        let client = Client::coarse(api, contact);
        client.expect(OK, client.setup(0.0, None));
        client.expect(OK, client.enter());
        client
    }

    /// In *stepComplete*, moving sideways where the contact model takes it, after the given changes of start values.
    pub fn running(api: &'a Api, contact: ContactModel, start: &[(&str, f64)]) -> Client<'a> {
        let client = Client::initializing(api, contact);
        client.expect(OK, client.set(sideways(contact)));
        client.expect(OK, client.set(start));
        client.expect(OK, client.exit());
        client
    }

    /// Chooses the contact model with a coarse grid, as after fmi2Reset.
    #[track_caller]
    pub fn make_coarse(&self) {
        self.expect(OK, self.set_integers(coarse(self.contact)));
    }

    /// Begins to run from *instantiated* with the values as they are.
    #[track_caller]
    pub fn start(&self) {
        self.expect(OK, self.setup(0.0, None));
        self.expect(OK, self.enter());
        self.expect(OK, self.exit());
    }

    /// Asserts a status, with the messages in the failure.
    #[track_caller]
    pub fn expect(&self, expected: c_int, status: c_int) {
        assert_eq!(status, expected, "{:#?}", self.journal.borrow());
    }

    /// The text of the last message, which is taken away with all others.
    pub fn last_message(&self) -> String {
        let message = self.journal.borrow_mut().drain(..).next_back();
        message.expect("a message").text
    }

    pub fn setup(&self, start: f64, stop: Option<f64>) -> c_int {
        // SAFETY: a live instance.
        unsafe {
            (self.api.setup_experiment)(
                self.component,
                0,
                0.0,
                start,
                c_int::from(stop.is_some()),
                stop.unwrap_or_default(),
            )
        }
    }

    pub fn enter(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { (self.api.enter_initialization)(self.component) }
    }

    pub fn exit(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { (self.api.exit_initialization)(self.component) }
    }

    pub fn step(&self, time: f64, size: f64) -> c_int {
        // SAFETY: a live instance.
        unsafe { (self.api.do_step)(self.component, time, size, 1) }
    }

    pub fn terminate(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { (self.api.terminate)(self.component) }
    }

    pub fn reset(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { (self.api.reset)(self.component) }
    }

    pub fn set(&self, values: &[(&str, f64)]) -> c_int {
        let references: Vec<u32> = values.iter().map(|(name, _)| reference(name)).collect();
        let values: Vec<f64> = values.iter().map(|(_, value)| *value).collect();
        // SAFETY: as many values as references.
        unsafe { (self.api.set_real)(self.component, references.as_ptr(), references.len(), values.as_ptr()) }
    }

    pub fn set_integers(&self, values: &[(&str, c_int)]) -> c_int {
        let references: Vec<u32> = values.iter().map(|(name, _)| reference(name)).collect();
        let values: Vec<c_int> = values.iter().map(|(_, value)| *value).collect();
        // SAFETY: as many values as references.
        unsafe { (self.api.set_integer)(self.component, references.as_ptr(), references.len(), values.as_ptr()) }
    }

    pub fn set_rates(&self, rates: &[(&str, c_int, f64)]) -> c_int {
        let references: Vec<u32> = rates.iter().map(|(name, _, _)| reference(name)).collect();
        let orders: Vec<c_int> = rates.iter().map(|(_, order, _)| *order).collect();
        let values: Vec<f64> = rates.iter().map(|(_, _, value)| *value).collect();
        let n = references.len();
        // SAFETY: as many values as references.
        unsafe {
            (self.api.set_input_derivatives)(self.component, references.as_ptr(), n, orders.as_ptr(), values.as_ptr())
        }
    }

    pub fn get_references(&self, references: &[u32], values: &mut [f64]) -> c_int {
        // SAFETY: as many values as references.
        unsafe {
            (self.api.get_real)(
                self.component,
                references.as_ptr(),
                references.len(),
                values.as_mut_ptr(),
            )
        }
    }

    /// One Real variable.
    #[track_caller]
    pub fn get(&self, name: &str) -> f64 {
        let mut value = [f64::NAN];
        self.expect(OK, self.get_references(&[reference(name)], &mut value));
        value[0]
    }

    /// All outputs, as bits.
    #[track_caller]
    pub fn outputs(&self) -> Vec<u64> {
        let outputs = table().iter().filter(|row| (1000..2000).contains(&row.reference));
        let references: Vec<u32> = outputs.map(|row| row.reference).collect();
        let mut values = vec![f64::NAN; references.len()];
        self.expect(OK, self.get_references(&references, &mut values));
        values.into_iter().map(f64::to_bits).collect()
    }

    #[track_caller]
    pub fn save(&self) -> Handle {
        let mut handle = std::ptr::null_mut();
        // SAFETY: a live instance and a variable.
        self.expect(OK, unsafe { (self.api.get_state)(self.component, &mut handle) });
        assert!(!handle.is_null());
        handle
    }

    pub fn restore(&self, handle: Handle) -> c_int {
        // SAFETY: a live instance.
        unsafe { (self.api.set_state)(self.component, handle) }
    }

    #[track_caller]
    pub fn serialize(&self, handle: Handle) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: a live instance and room for the bytes.
        unsafe {
            self.expect(OK, (self.api.serialized_size)(self.component, handle, &mut size));
            let mut bytes = vec![0_u8; size];
            self.expect(
                OK,
                (self.api.serialize)(self.component, handle, bytes.as_mut_ptr().cast(), size),
            );
            bytes
        }
    }

    pub fn deserialize(&self, bytes: &[u8], handle: &mut Handle) -> c_int {
        // SAFETY: a live instance and valid bytes.
        unsafe { (self.api.deserialize)(self.component, bytes.as_ptr().cast(), bytes.len(), handle) }
    }
}

/// The value reference of a variable.
#[track_caller]
pub fn reference(name: &str) -> u32 {
    find(name).reference
}

#[track_caller]
pub fn find(name: &str) -> &'static Variable {
    let row = table().iter().find(|row| row.name == name);
    row.unwrap_or_else(|| panic!("no variable {name}"))
}

/// The table of variables, made once: with its names it takes as long as many a call.
fn table() -> &'static [Variable] {
    static TABLE: LazyLock<Vec<Variable>> = LazyLock::new(variables);
    &TABLE
}
