#include <dspace/orientation/FrameTable.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <limits>

#include <dspace/Error.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/orientation/InertialFrames.h>

namespace dspace {
namespace {

std::string Upper(std::string text) {
  for (char& c : text) {
    c = char(std::toupper(static_cast<unsigned char>(c)));
  }
  return text;
}

struct BodyFrame {
  const char* name;
  int id;
  int body;
};

// Frames that follow a body's rotation constants, as CSPICE N0067 has them.
constexpr BodyFrame BodyFrames[] = {
    {"IAU_MERCURY_BARYCENTER", 10001, 1},
    {"IAU_VENUS_BARYCENTER", 10002, 2},
    {"IAU_EARTH_BARYCENTER", 10003, 3},
    {"IAU_MARS_BARYCENTER", 10004, 4},
    {"IAU_JUPITER_BARYCENTER", 10005, 5},
    {"IAU_SATURN_BARYCENTER", 10006, 6},
    {"IAU_URANUS_BARYCENTER", 10007, 7},
    {"IAU_NEPTUNE_BARYCENTER", 10008, 8},
    {"IAU_PLUTO_BARYCENTER", 10009, 9},
    {"IAU_SUN", 10010, 10},
    {"IAU_MERCURY", 10011, 199},
    {"IAU_VENUS", 10012, 299},
    {"IAU_EARTH", 10013, 399},
    {"IAU_MARS", 10014, 499},
    {"IAU_JUPITER", 10015, 599},
    {"IAU_SATURN", 10016, 699},
    {"IAU_URANUS", 10017, 799},
    {"IAU_NEPTUNE", 10018, 899},
    {"IAU_PLUTO", 10019, 999},
    {"IAU_MOON", 10020, 301},
    {"IAU_PHOBOS", 10021, 401},
    {"IAU_DEIMOS", 10022, 402},
    {"IAU_IO", 10023, 501},
    {"IAU_EUROPA", 10024, 502},
    {"IAU_GANYMEDE", 10025, 503},
    {"IAU_CALLISTO", 10026, 504},
    {"IAU_AMALTHEA", 10027, 505},
    {"IAU_HIMALIA", 10028, 506},
    {"IAU_ELARA", 10029, 507},
    {"IAU_PASIPHAE", 10030, 508},
    {"IAU_SINOPE", 10031, 509},
    {"IAU_LYSITHEA", 10032, 510},
    {"IAU_CARME", 10033, 511},
    {"IAU_ANANKE", 10034, 512},
    {"IAU_LEDA", 10035, 513},
    {"IAU_THEBE", 10036, 514},
    {"IAU_ADRASTEA", 10037, 515},
    {"IAU_METIS", 10038, 516},
    {"IAU_MIMAS", 10039, 601},
    {"IAU_ENCELADUS", 10040, 602},
    {"IAU_TETHYS", 10041, 603},
    {"IAU_DIONE", 10042, 604},
    {"IAU_RHEA", 10043, 605},
    {"IAU_TITAN", 10044, 606},
    {"IAU_HYPERION", 10045, 607},
    {"IAU_IAPETUS", 10046, 608},
    {"IAU_PHOEBE", 10047, 609},
    {"IAU_JANUS", 10048, 610},
    {"IAU_EPIMETHEUS", 10049, 611},
    {"IAU_HELENE", 10050, 612},
    {"IAU_TELESTO", 10051, 613},
    {"IAU_CALYPSO", 10052, 614},
    {"IAU_ATLAS", 10053, 615},
    {"IAU_PROMETHEUS", 10054, 616},
    {"IAU_PANDORA", 10055, 617},
    {"IAU_ARIEL", 10056, 701},
    {"IAU_UMBRIEL", 10057, 702},
    {"IAU_TITANIA", 10058, 703},
    {"IAU_OBERON", 10059, 704},
    {"IAU_MIRANDA", 10060, 705},
    {"IAU_CORDELIA", 10061, 706},
    {"IAU_OPHELIA", 10062, 707},
    {"IAU_BIANCA", 10063, 708},
    {"IAU_CRESSIDA", 10064, 709},
    {"IAU_DESDEMONA", 10065, 710},
    {"IAU_JULIET", 10066, 711},
    {"IAU_PORTIA", 10067, 712},
    {"IAU_ROSALIND", 10068, 713},
    {"IAU_BELINDA", 10069, 714},
    {"IAU_PUCK", 10070, 715},
    {"IAU_TRITON", 10071, 801},
    {"IAU_NEREID", 10072, 802},
    {"IAU_NAIAD", 10073, 803},
    {"IAU_THALASSA", 10074, 804},
    {"IAU_DESPINA", 10075, 805},
    {"IAU_GALATEA", 10076, 806},
    {"IAU_LARISSA", 10077, 807},
    {"IAU_PROTEUS", 10078, 808},
    {"IAU_CHARON", 10079, 901},
    {"IAU_PAN", 10082, 618},
    {"IAU_GASPRA", 10083, 9511010},
    {"IAU_IDA", 10084, 2431010},
    {"IAU_EROS", 10085, 2000433},
    {"IAU_CALLIRRHOE", 10086, 517},
    {"IAU_THEMISTO", 10087, 518},
    {"IAU_MEGACLITE", 10088, 519},
    {"IAU_TAYGETE", 10089, 520},
    {"IAU_CHALDENE", 10090, 521},
    {"IAU_HARPALYKE", 10091, 522},
    {"IAU_KALYKE", 10092, 523},
    {"IAU_IOCASTE", 10093, 524},
    {"IAU_ERINOME", 10094, 525},
    {"IAU_ISONOE", 10095, 526},
    {"IAU_PRAXIDIKE", 10096, 527},
    {"IAU_BORRELLY", 10097, 1000005},
    {"IAU_TEMPEL_1", 10098, 1000093},
    {"IAU_VESTA", 10099, 2000004},
    {"IAU_ITOKAWA", 10100, 2025143},
    {"IAU_CERES", 10101, 2000001},
    {"IAU_PALLAS", 10102, 2000002},
    {"IAU_LUTETIA", 10103, 2000021},
    {"IAU_DAVIDA", 10104, 2000511},
    {"IAU_STEINS", 10105, 2002867},
    {"IAU_BENNU", 10106, 2101955},
    {"IAU_52_EUROPA", 10107, 2000052},
    {"IAU_NIX", 10108, 902},
    {"IAU_HYDRA", 10109, 903},
    {"IAU_RYUGU", 10110, 2162173},
    {"IAU_ARROKOTH", 10111, 2486958},
};

FrameClass ToClass(int kind, const std::string& variable) {
  if (kind < 1 || kind > 6) {
    throw Error(Error::Kind::Corrupt, "kernel variable '" + variable + "'",
                "the frame's class is " + std::to_string(kind) + "; accepted: 1 to 6");
  }
  return FrameClass(kind);
}

constexpr int UnknownBody = std::numeric_limits<int>::min();

// The value of FRAME_<id>_<item> or FRAME_<name>_<item>; null: neither.
const KernelVariable* ItemOf(const KernelPool& pool, const FrameInfo& info, const char* item,
                             std::string* variable) {
  for (const std::string& key : {std::to_string(info.id), info.name}) {
    *variable = "FRAME_" + key + "_" + item;
    if (const KernelVariable* found = pool.Find(*variable)) {
      return found;
    }
  }
  *variable = "FRAME_" + std::to_string(info.id) + "_" + item;
  return nullptr;
}

} // namespace

FrameTable::FrameTable(const KernelPool& pool) {
  for (int id = 1; id <= InertialFrameCount; ++id) {
    this->Add({InertialFrameName(id), id, FrameClass::Inertial, id, 0, {}});
  }
  for (const BodyFrame& frame : BodyFrames) {
    this->Add({frame.name, frame.id, FrameClass::Pck, frame.body, frame.body, {}});
  }
  this->Add({"ITRF93", FrameItrf93, FrameClass::Pck, 3000, 399, {}});
  this->Add({"EARTH_FIXED", FrameEarthFixed, FrameClass::Tk, FrameEarthFixed, 399, {}});
  this->Add({"MOON_PA", FrameMoonPa, FrameClass::Pck, FrameMoonPa, 301, {}});
  this->Add({"MOON_ME", FrameMoonMe, FrameClass::Pck, FrameMoonMe, 301, {}});

  BodyNames bodies;
  if (pool.Has("NAIF_BODY_NAME") && pool.Has("NAIF_BODY_CODE")) {
    const std::vector<std::string>& names = pool.Texts("NAIF_BODY_NAME");
    const std::vector<double>& codes = pool.Numbers("NAIF_BODY_CODE", names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      bodies.Define(names[i], int(codes[i]));
    }
  }
  const std::string prefix = "FRAME_";
  for (auto it = pool.Variables().lower_bound(prefix); it != pool.Variables().end(); ++it) {
    const auto& [variable, value] = *it;
    if (variable.compare(0, prefix.size(), prefix) != 0) {
      break;
    }
    if (value.isText || value.numbers.size() != 1) {
      continue; // no FRAME_<name> = <id>
    }
    FrameInfo info;
    info.name = variable.substr(prefix.size());
    std::string item;
    info.id = int(value.numbers[0]);
    if (double(info.id) != value.numbers[0] || !ItemOf(pool, info, "CLASS", &item)) {
      continue; // FRAME_<id>_CLASS and the like
    }
    info.kernel = value.file;
    info.kind = ToClass(pool.Integer(item), item);
    if (!ItemOf(pool, info, "CLASS_ID", &item)) {
      throw Error(Error::Kind::Corrupt, "frame '" + info.name + "'",
                  "kernel '" + value.file + "' defines it without " + item);
    }
    info.classId = pool.Integer(item);
    const KernelVariable* center = ItemOf(pool, info, "CENTER", &item);
    if (!center) {
      throw Error(Error::Kind::Corrupt, "frame '" + info.name + "'",
                  "kernel '" + value.file + "' defines it without " + item);
    }
    if (center->isText) {
      // A spacecraft whose name no loaded kernel knows: an error where the centre is needed.
      info.center = bodies.Find(pool.Text(item)).value_or(UnknownBody);
    } else {
      info.center = pool.Integer(item);
    }
    const FrameInfo* present = this->Find(info.id);
    const bool builtIn =
        present && present->kernel.empty() && info.id != FrameMoonPa && info.id != FrameMoonMe;
    if (!builtIn) {
      this->Add(std::move(info));
    }
  }
}

void FrameTable::Add(FrameInfo info) {
  this->Ids_[Upper(info.name)] = info.id;
  this->Frames_[info.id] = std::move(info);
}

const FrameInfo* FrameTable::Find(const std::string& name) const {
  const auto found = this->Ids_.find(Upper(name));
  return found == this->Ids_.end() ? nullptr : this->Find(found->second);
}

const FrameInfo* FrameTable::Find(int id) const {
  const auto found = this->Frames_.find(id);
  return found == this->Frames_.end() ? nullptr : &found->second;
}

const FrameInfo& FrameTable::Get(const std::string& name) const {
  if (const FrameInfo* found = this->Find(name)) {
    return *found;
  }
  const std::string near = NearMatches(name, this->Names());
  throw Error(Error::Kind::NotFound, "frame '" + name + "'",
              "there is no such reference frame; " +
                  (near.empty() ? "accepted: J2000, ECLIPJ2000, IAU_MOON and other IAU_ frames, "
                                  "MOON_ME, MOON_PA, ITRF93, and frames of loaded kernels"
                                : "close to it: " + near));
}

const FrameInfo& FrameTable::Get(int id) const {
  if (const FrameInfo* found = this->Find(id)) {
    return *found;
  }
  throw Error(Error::Kind::NotFound, "frame " + std::to_string(id),
              "no loaded kernel defines a reference frame of this id");
}

const FrameInfo& FrameTable::BodyFixed(int body) const {
  if (body == 301 || body == 399) {
    return this->Get(body == 301 ? FrameMoonMe : FrameItrf93);
  }
  const FrameInfo* loaded = nullptr;
  for (const auto& [id, info] : this->Frames_) {
    if (info.kind == FrameClass::Pck && info.center == body) {
      if (info.kernel.empty()) {
        return info;
      }
      loaded = loaded ? loaded : &info;
    }
  }
  if (!loaded) {
    throw Error(Error::Kind::NotFound, "body " + std::to_string(body),
                "no frame that turns with it is known; accepted: a body with an IAU_ frame, or a "
                "frame of a loaded kernel, by name");
  }
  return *loaded;
}

std::vector<std::string> FrameTable::Names() const {
  std::vector<std::string> out;
  for (const auto& [id, info] : this->Frames_) {
    out.push_back(info.name);
  }
  return out;
}

std::vector<const FrameInfo*> FrameTable::Loaded() const {
  std::vector<const FrameInfo*> out;
  for (const auto& [id, info] : this->Frames_) {
    if (!info.kernel.empty()) {
      out.push_back(&info);
    }
  }
  return out;
}

} // namespace dspace
