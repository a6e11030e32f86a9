//! The companies that report, with their ways. All are invented; their shares are those of the real file's companies.

/// A company that reports, with its ways.
pub struct Entity {
    pub name: &'static str,
    pub operator: &'static str,
    pub id_prefix: u32,
    pub subject: &'static str,
    pub make: &'static str,
    pub model: &'static str,
    pub driver: &'static str,
    /// Its share of the incidents off the highway.
    pub share: f64,
    /// Share of its incidents that it tells again in a later version.
    pub updates: f64,
    /// Who files a copy of its reports, and of what share of them.
    pub copied: Option<(&'static Copier, f64)>,
    /// Share of its narratives that are withheld in part.
    pub withholds: f64,
    /// Masks streets and days as `[XXX]`, as NHTSA does.
    pub masks: bool,
    pub openings: &'static [&'static str],
    pub engaged: &'static [&'static str],
    /// How it tells that a person took over before the contact; nothing where nobody can.
    pub taken_over: &'static [&'static str],
    pub closing: &'static str,
}

/// A company that files copies of another one's reports.
pub struct Copier {
    pub name: &'static str,
    pub id_prefix: u32,
    /// Stands before the copied narrative, or in its place where it names the report: `{report}`.
    pub opening: &'static str,
    pub closing: &'static str,
}

impl Copier {
    /// Whether it only names the report that tells the crash.
    pub fn only_refers(&self) -> bool {
        self.opening.contains("{report}")
    }
}

static QUILL: Copier = Copier {
    name: "Quill Motors of America",
    id_prefix: 90107,
    opening: "Quill Motors built the vehicle that Calder Autonomy operates and has no account of its own. Please refer to \
              report {report} of Calder Autonomy for narrative details.",
    closing: "",
};
static TERN: Copier = Copier {
    name: "Tern Transit Services",
    id_prefix: 90105,
    opening: "",
    closing: " Tern Transit Services files this as the employer of the safety operator.",
};
static DUNMORE: Copier = Copier {
    name: "Dunmore Motor Company",
    id_prefix: 90110,
    opening: "Dunmore built the vehicle that Sable Autonomy operates, and passes on Sable's account below without having \
              looked into it. ",
    closing: "",
};
static OXBRIDGE: Copier = Copier {
    name: "Oxbridge Trucks, Inc.",
    id_prefix: 90111,
    opening: "The maker of the truck, Oxbridge, was told of this event by Haulwright, whose words follow. ",
    closing: "",
};

/// The shuttle company, which has months without any news.
pub const BRIGHTLANE: usize = 4;

/// The truck company, which drives on highways only.
pub const HAULWRIGHT: usize = 8;

pub static ENTITIES: &[Entity] = &[
    Entity {
        name: "Northlight Robotics, Inc.",
        operator: "Northlight Robotics",
        id_prefix: 90101,
        subject: "the Northlight AV",
        make: "Northlight",
        model: "N3",
        driver: "None",
        share: 0.55,
        updates: 0.27,
        copied: None,
        withholds: 0.16,
        masks: true,
        openings: &[
            "On {month} [XXX], {year} at {clock} a Northlight AV was in a crash involving {cp} in {city}.\n",
            "On {month} [XXX], {year} at {clock} a Northlight AV operating in {city} was in a collision on {street}.\n",
        ],
        engaged: &[
            "The automated driving system was engaged.",
            "The ADS was active throughout.",
            "The ADS was on and nobody was in the driver's seat.",
        ],
        taken_over: &[],
        closing: " Northlight will amend this report if it learns more.",
    },
    Entity {
        name: "Northlight Robotics, Inc.",
        operator: "Northlight Robotics",
        id_prefix: 90101,
        subject: "the Northlight AV",
        make: "Northlight",
        model: "N2",
        driver: "In-Vehicle (Commercial / Test)",
        share: 0.18,
        updates: 0.27,
        copied: Some((&TERN, 0.5)),
        withholds: 0.14,
        masks: true,
        openings: &[
            "On {month} [XXX], {year} at {clock} a Northlight AV with a test driver on board was in a collision in {city}.\n",
            "On {month} [XXX], {year} at {clock} a Northlight AV was in a crash involving {cp} in {city}.\n",
        ],
        engaged: &["The ADS was engaged and a test driver was present.", "The ADS was engaged at the time."],
        taken_over: &[
            "The test driver took over manual control shortly before the impact.",
            "The test driver disengaged the ADS about one second before the contact.",
        ],
        closing: " Northlight will amend this report if it learns more.",
    },
    Entity {
        name: "Calder Autonomy",
        operator: "Calder Autonomy",
        id_prefix: 90102,
        subject: "the Calder test vehicle",
        make: "Quill",
        model: "Vantage",
        driver: "In-Vehicle (Commercial / Test)",
        share: 0.10,
        updates: 0.05,
        copied: Some((&QUILL, 0.9)),
        withholds: 0.85,
        masks: false,
        openings: &[""],
        engaged: &[
            "The vehicle was in autonomous mode with a test driver at the wheel.",
            "It was driving in autonomous mode.",
        ],
        taken_over: &["The test driver took over about one second before the contact."],
        closing: "",
    },
    Entity {
        name: "Meridian Drive LLC",
        operator: "Meridian Drive",
        id_prefix: 90103,
        subject: "the Meridian AV",
        make: "Meridian",
        model: "One",
        driver: "Remote (Commercial / Test)",
        share: 0.07,
        updates: 0.1,
        copied: None,
        withholds: 0.0,
        masks: false,
        openings: &["{city}, {street} near {cross}, {clock}. "],
        engaged: &["Level 4 operation was active.", "The AV was in driverless operation, watched from remote."],
        taken_over: &[],
        closing: " Logs and video have been kept.",
    },
    Entity {
        name: "Brightlane Mobility Co.",
        operator: "Brightlane Mobility",
        id_prefix: 90104,
        subject: "the Brightlane shuttle",
        make: "Brightlane",
        model: "Loop 8",
        driver: "In-Vehicle and Remote (Commercial / Test)",
        share: 0.025,
        updates: 0.1,
        copied: None,
        withholds: 0.0,
        masks: false,
        openings: &["Report from the shuttle route in {city}. "],
        engaged: &["An attendant was on board. The shuttle was in automated mode."],
        taken_over: &["The attendant had pressed the stop button and was driving by hand."],
        closing: " Service was paused for the day.",
    },
    Entity {
        name: "Tern Transit Services",
        operator: "Tern Transit Services",
        id_prefix: 90105,
        subject: "the AV",
        make: "Northlight",
        model: "N2",
        driver: "In-Vehicle (Commercial / Test)",
        share: 0.02,
        updates: 0.1,
        copied: None,
        withholds: 0.16,
        masks: true,
        openings: &["{clock} local time, {city}. "],
        engaged: &["The safety operator had hands off the wheel and the ADS was engaged."],
        taken_over: &["The safety operator braked and steered shortly before the impact."],
        closing: " Tern Transit Services files this as the employer of the safety operator.",
    },
    Entity {
        name: "Sable Autonomy",
        operator: "Sable Autonomy",
        id_prefix: 90108,
        subject: "the Sable test vehicle",
        make: "Dunmore",
        model: "Ferry",
        driver: "In-Vehicle (Commercial / Test)",
        share: 0.03,
        updates: 0.0,
        copied: Some((&DUNMORE, 1.0)),
        withholds: 0.5,
        masks: false,
        openings: &[""],
        engaged: &["The self-driving system was engaged and a test driver was in the driver's seat."],
        taken_over: &["The test driver took manual control before the contact."],
        closing: "",
    },
    Entity {
        name: "Larch Robotics Corp.",
        operator: "Larch Robotics",
        id_prefix: 90109,
        subject: "the Larch AV",
        make: "Larch",
        model: "Pod 2",
        driver: "None",
        share: 0.025,
        updates: 0.2,
        copied: None,
        withholds: 0.2,
        masks: false,
        openings: &["In {city} in {month} {year}: "],
        engaged: &["The ADS was engaged.", "The vehicle was operating autonomously without an occupant."],
        taken_over: &[],
        closing: "",
    },
    Entity {
        name: "Haulwright Trucking Systems",
        operator: "Haulwright Trucking Systems",
        id_prefix: 90106,
        subject: "the Haulwright truck",
        make: "Oxbridge",
        model: "T780",
        driver: "In-Vehicle (Commercial / Test)",
        share: 0.0,
        updates: 0.1,
        copied: Some((&OXBRIDGE, 0.5)),
        withholds: 0.0,
        masks: true,
        openings: &[""],
        engaged: &["The truck was driving autonomously with a licensed driver on board."],
        taken_over: &["The licensed driver took over before the contact."],
        closing: " The trailer was inspected and released.",
    },
];
