#include <dspace/ephemeris/BodyNames.h>

#include <algorithm>
#include <cctype>
#include <charconv>

#include <dspace/Error.h>

namespace dspace {
namespace {

struct Named {
  int id;
  const char* name;
};

// The name that comes first for an id is the one that it is called by.
constexpr Named BuiltIn[] = {{0, "SOLAR SYSTEM BARYCENTER"},
                             {0, "SSB"},
                             {1, "MERCURY BARYCENTER"},
                             {2, "VENUS BARYCENTER"},
                             {3, "EARTH BARYCENTER"},
                             {3, "EARTH MOON BARYCENTER"},
                             {3, "EMB"},
                             {4, "MARS BARYCENTER"},
                             {5, "JUPITER BARYCENTER"},
                             {6, "SATURN BARYCENTER"},
                             {7, "URANUS BARYCENTER"},
                             {8, "NEPTUNE BARYCENTER"},
                             {9, "PLUTO BARYCENTER"},
                             {10, "SUN"},
                             {199, "MERCURY"},
                             {299, "VENUS"},
                             {399, "EARTH"},
                             {301, "MOON"},
                             {499, "MARS"},
                             {401, "PHOBOS"},
                             {402, "DEIMOS"},
                             {599, "JUPITER"},
                             {501, "IO"},
                             {502, "EUROPA"},
                             {503, "GANYMEDE"},
                             {504, "CALLISTO"},
                             {505, "AMALTHEA"},
                             {506, "HIMALIA"},
                             {507, "ELARA"},
                             {508, "PASIPHAE"},
                             {509, "SINOPE"},
                             {510, "LYSITHEA"},
                             {511, "CARME"},
                             {512, "ANANKE"},
                             {513, "LEDA"},
                             {514, "THEBE"},
                             {515, "ADRASTEA"},
                             {516, "METIS"},
                             {699, "SATURN"},
                             {601, "MIMAS"},
                             {602, "ENCELADUS"},
                             {603, "TETHYS"},
                             {604, "DIONE"},
                             {605, "RHEA"},
                             {606, "TITAN"},
                             {607, "HYPERION"},
                             {608, "IAPETUS"},
                             {609, "PHOEBE"},
                             {610, "JANUS"},
                             {611, "EPIMETHEUS"},
                             {612, "HELENE"},
                             {613, "TELESTO"},
                             {614, "CALYPSO"},
                             {615, "ATLAS"},
                             {616, "PROMETHEUS"},
                             {617, "PANDORA"},
                             {618, "PAN"},
                             {632, "METHONE"},
                             {633, "PALLENE"},
                             {634, "POLYDEUCES"},
                             {635, "DAPHNIS"},
                             {649, "ANTHE"},
                             {653, "AEGAEON"},
                             {799, "URANUS"},
                             {701, "ARIEL"},
                             {702, "UMBRIEL"},
                             {703, "TITANIA"},
                             {704, "OBERON"},
                             {705, "MIRANDA"},
                             {706, "CORDELIA"},
                             {707, "OPHELIA"},
                             {708, "BIANCA"},
                             {709, "CRESSIDA"},
                             {710, "DESDEMONA"},
                             {711, "JULIET"},
                             {712, "PORTIA"},
                             {713, "ROSALIND"},
                             {714, "BELINDA"},
                             {715, "PUCK"},
                             {716, "CALIBAN"},
                             {717, "SYCORAX"},
                             {899, "NEPTUNE"},
                             {801, "TRITON"},
                             {802, "NEREID"},
                             {803, "NAIAD"},
                             {804, "THALASSA"},
                             {805, "DESPINA"},
                             {806, "GALATEA"},
                             {807, "LARISSA"},
                             {808, "PROTEUS"},
                             {999, "PLUTO"},
                             {901, "CHARON"},
                             {902, "NIX"},
                             {903, "HYDRA"},
                             {904, "KERBEROS"},
                             {905, "STYX"},
                             {2000001, "CERES"},
                             {2000002, "PALLAS"},
                             {2000004, "VESTA"},
                             {2000016, "PSYCHE"},
                             {2000021, "LUTETIA"},
                             {2000433, "EROS"},
                             {2000243, "IDA"},
                             {2431010, "IDA SYSTEM"},
                             {2025143, "ITOKAWA"},
                             {2101955, "BENNU"},
                             {2162173, "RYUGU"},
                             {2486958, "ARROKOTH"},
                             {9511010, "GASPRA"},
                             {1000012, "CHURYUMOV-GERASIMENKO"},
                             {1000093, "TEMPEL 1"},
                             {-5, "AKATSUKI"},
                             {-6, "PIONEER 6"},
                             {-12, "PIONEER 12"},
                             {-18, "LCROSS"},
                             {-21, "SOHO"},
                             {-23, "PIONEER 10"},
                             {-24, "PIONEER 11"},
                             {-25, "LUNAR PROSPECTOR"},
                             {-28, "JUICE"},
                             {-29, "STARDUST"},
                             {-31, "VOYAGER 1"},
                             {-32, "VOYAGER 2"},
                             {-37, "HAYABUSA2"},
                             {-40, "CLEMENTINE"},
                             {-41, "MARS EXPRESS"},
                             {-41, "MEX"},
                             {-44, "BEAGLE 2"},
                             {-47, "GENESIS"},
                             {-48, "HUBBLE SPACE TELESCOPE"},
                             {-48, "HST"},
                             {-49, "LUCY"},
                             {-53, "MARS ODYSSEY"},
                             {-53, "M01"},
                             {-55, "ULYSSES"},
                             {-61, "JUNO"},
                             {-64, "OSIRIS-REX"},
                             {-64, "ORX"},
                             {-74, "MARS RECON ORBITER"},
                             {-74, "MRO"},
                             {-76, "MARS SCIENCE LABORATORY"},
                             {-76, "MSL"},
                             {-76, "CURIOSITY"},
                             {-77, "GALILEO ORBITER"},
                             {-77, "GLL"},
                             {-79, "SPITZER"},
                             {-82, "CASSINI"},
                             {-82, "CAS"},
                             {-84, "PHOENIX"},
                             {-85, "LUNAR RECONNAISSANCE ORBITER"},
                             {-85, "LRO"},
                             {-93, "NEAR"},
                             {-94, "MARS GLOBAL SURVEYOR"},
                             {-94, "MGS"},
                             {-95, "MGS SIMULATION"},
                             {-96, "PARKER SOLAR PROBE"},
                             {-96, "SPP"},
                             {-98, "NEW HORIZONS"},
                             {-98, "NH"},
                             {-121, "BEPICOLOMBO MPO"},
                             {-130, "HAYABUSA"},
                             {-131, "SELENE"},
                             {-131, "KAGUYA"},
                             {-140, "DEEP IMPACT FLYBY SPACECRAFT"},
                             {-140, "EPOXI"},
                             {-143, "EXOMARS TGO"},
                             {-143, "TGO"},
                             {-144, "SOLAR ORBITER"},
                             {-144, "SOLO"},
                             {-146, "LUNAR-A"},
                             {-150, "CASSINI PROBE"},
                             {-150, "HUYGENS PROBE"},
                             {-151, "CHANDRA"},
                             {-152, "CHANDRAYAAN-2"},
                             {-155, "KPLO"},
                             {-155, "DANURI"},
                             {-159, "EUROPA CLIPPER"},
                             {-168, "MARS 2020"},
                             {-168, "PERSEVERANCE"},
                             {-170, "JWST"},
                             {-177, "GRAIL-A"},
                             {-181, "GRAIL-B"},
                             {-189, "INSIGHT"},
                             {-202, "MAVEN"},
                             {-203, "DAWN"},
                             {-226, "ROSETTA"},
                             {-227, "KEPLER"},
                             {-234, "STEREO AHEAD"},
                             {-235, "STEREO BEHIND"},
                             {-236, "MESSENGER"},
                             {-248, "VENUS EXPRESS"},
                             {-253, "OPPORTUNITY"},
                             {-253, "MER-1"},
                             {-254, "SPIRIT"},
                             {-254, "MER-2"},
                             {-255, "PSYCHE SPACECRAFT"},
                             {-362, "RADIATION BELT STORM PROBE A"},
                             {-363, "RADIATION BELT STORM PROBE B"},
                             {-530, "MARS PATHFINDER"},
                             {-530, "MPF"},
                             {-1023, "ARTEMIS I ORION"},
                             {-1023, "ORION"},
                             {399001, "GOLDSTONE"},
                             {399002, "CANBERRA"},
                             {399003, "MADRID"},
                             {399004, "USUDA"},
                             {399005, "DSS-05"},
                             {399005, "PARKES"},
                             {399012, "DSS-12"},
                             {399013, "DSS-13"},
                             {399014, "DSS-14"},
                             {399015, "DSS-15"},
                             {399016, "DSS-16"},
                             {399017, "DSS-17"},
                             {399023, "DSS-23"},
                             {399024, "DSS-24"},
                             {399025, "DSS-25"},
                             {399026, "DSS-26"},
                             {399027, "DSS-27"},
                             {399028, "DSS-28"},
                             {399033, "DSS-33"},
                             {399034, "DSS-34"},
                             {399035, "DSS-35"},
                             {399036, "DSS-36"},
                             {399042, "DSS-42"},
                             {399043, "DSS-43"},
                             {399045, "DSS-45"},
                             {399046, "DSS-46"},
                             {399049, "DSS-49"},
                             {399053, "DSS-53"},
                             {399054, "DSS-54"},
                             {399055, "DSS-55"},
                             {399056, "DSS-56"},
                             {399061, "DSS-61"},
                             {399063, "DSS-63"},
                             {399064, "DSS-64"},
                             {399065, "DSS-65"},
                             {399066, "DSS-66"}};

// Upper case, single blanks for underscores and blanks.
std::string Folded(const std::string& name) {
  std::string folded;
  for (const char c : name) {
    const bool blank = c == '_' || c == ' ' || c == '\t';
    if (blank && (folded.empty() || folded.back() == ' ')) {
      continue;
    }
    folded += blank ? ' ' : char(std::toupper(static_cast<unsigned char>(c)));
  }
  if (!folded.empty() && folded.back() == ' ') {
    folded.pop_back();
  }
  return folded;
}

} // namespace

BodyNames::BodyNames() {
  for (const Named& named : BuiltIn) {
    this->Ids_.emplace(named.name, named.id);
    this->Names_.emplace(named.id, named.name);
  }
}

std::optional<int> BodyNames::Find(const std::string& name) const {
  const std::string folded = Folded(name);
  const auto found = this->Ids_.find(folded);
  if (found != this->Ids_.end()) {
    return found->second;
  }
  int id = 0;
  const char* end = folded.data() + folded.size();
  const auto read = std::from_chars(folded.data(), end, id);
  return read.ec == std::errc() && read.ptr == end && !folded.empty() ? std::optional<int>(id)
                                                                      : std::nullopt;
}

int BodyNames::IdOf(const std::string& name) const {
  const std::optional<int> id = this->Find(name);
  if (!id) {
    throw Error(Error::Kind::NotFound, "body '" + name + "'",
                "its name is unknown; accepted: names such as SUN, MOON, EARTH, MARS, JUPITER "
                "BARYCENTER, those that text kernels define, and NAIF's ids");
  }
  return *id;
}

std::string BodyNames::NameOf(int id) const {
  const auto found = this->Names_.find(id);
  return found == this->Names_.end() ? std::to_string(id) : found->second;
}

void BodyNames::Define(const std::string& name, int id) {
  const std::string folded = Folded(name);
  if (folded.empty()) {
    throw Error(Error::Kind::InvalidArgument, "body " + std::to_string(id),
                "its name is empty; accepted: any other");
  }
  this->Ids_[folded] = id;
  this->Names_[id] = folded;
}

} // namespace dspace
