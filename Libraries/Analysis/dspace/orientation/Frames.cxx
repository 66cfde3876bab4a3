#include <dspace/orientation/Frames.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <dspace/Checks.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/orientation/AxisTurns.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/orientation/EarthRotation.h>
#include <dspace/orientation/InertialFrames.h>
#include <dspace/time/UtcText.h>

namespace dspace {
namespace {

constexpr int LongestChain = 32;
constexpr double Arcsecond = M_PI / 648000.0;

std::string Label(const FrameInfo& info) {
  return "frame '" + info.name + "'";
}

// [rad] of one unit of TKFRAME_..._UNITS.
double AngleUnit(const std::string& word, const std::string& variable) {
  static const std::pair<const char*, double> Units[] = {{"RADIANS", 1.0},
                                                         {"DEGREES", M_PI / 180.0},
                                                         {"ARCMINUTES", M_PI / 10800.0},
                                                         {"ARCSECONDS", Arcsecond},
                                                         {"HOURANGLE", M_PI / 12.0},
                                                         {"MINUTEANGLE", M_PI / 720.0},
                                                         {"SECONDANGLE", M_PI / 43200.0}};
  for (const auto& [name, unit] : Units) {
    if (word == name) {
      return unit;
    }
  }
  throw Error(Error::Kind::Corrupt, "kernel variable '" + variable + "'",
              "the unit is '" + word +
                  "'; accepted: RADIANS, DEGREES, ARCMINUTES, ARCSECONDS, "
                  "HOURANGLE, MINUTEANGLE, SECONDANGLE");
}

Eigen::Matrix3d Skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

std::string FileName(const DafFile& file) {
  return "'" + file.Path() + "'";
}

// "2013-02-25T00:01:00 UTC to ...", at most five, for errors.
std::string SpansText(std::vector<std::pair<double, double>> spans, const TimeScales& scales) {
  std::sort(spans.begin(), spans.end());
  std::vector<std::pair<double, double>> merged;
  for (const auto& span : spans) {
    if (!merged.empty() && span.first <= merged.back().second + 1.0) {
      merged.back().second = std::max(merged.back().second, span.second);
    } else {
      merged.push_back(span);
    }
  }
  std::string out;
  for (std::size_t i = 0; i < merged.size() && i < 5; ++i) {
    out += (i ? ", " : "") + TimeLabel(merged[i].first, scales) + " to " +
           TimeLabel(merged[i].second, scales);
  }
  return merged.size() > 5 ? out + ", ..." : out;
}

} // namespace

// Links from a frame upwards; `base[i]` is the frame that `links[i]` leads to.
struct Frames::Chain {
  std::vector<int> frames;   // the frame itself first
  std::vector<Link> links;   // frames[i] against frames[i + 1]
  std::exception_ptr broken; // why it ends before J2000
};

Eigen::Matrix3d De405MeFromPa() {
  // DE405 states none. These make its axes those of MOON_ME_DE421 (moon_080317.tf) in the mean of
  // 1960 to 2050; what remains changes with time and is at most 0.28 arcsec. With the angles of
  // DE403 (0.1462, 79.0768, 63.8986) 1.42 arcsec would remain, with DE421's (0.30, 78.56, 67.92)
  // 5.5 arcsec.
  return AxisTurn(-0.2958 * Arcsecond, 1) * AxisTurn(-79.1173 * Arcsecond, 2) *
         AxisTurn(-62.7185 * Arcsecond, 3);
}

Frames::Frames(FrameSources sources)
    : Sources_([&] {
        if (!sources.pool) {
          sources.pool = std::make_shared<const KernelPool>();
        }
        return std::move(sources);
      }()),
      Table_(*this->Sources_.pool) {
  for (const std::string& name : this->Table_.Names()) {
    const FrameInfo& info = this->Table_.Get(name);
    if (info.kind == FrameClass::Tk && (!info.kernel.empty() || info.id == FrameEarthFixed)) {
      if (info.id == FrameEarthFixed && !this->Pool().Has("TKFRAME_EARTH_FIXED_RELATIVE") &&
          !this->Pool().Has("TKFRAME_10081_RELATIVE")) {
        continue; // SPICE leaves its definition to a kernel
      }
      try {
        this->Fixed_[info.id] = this->TkLink(info);
      } catch (const Error& error) {
        // Relative to a frame of a kernel that may be loaded later: an error where it is used.
        if (error.GetKind() != Error::Kind::NotFound) {
          throw;
        }
      }
    }
  }
  for (const int clock : ClockKernel::Clocks(this->Pool())) {
    try {
      this->Clocks_[clock] =
          std::make_shared<const ClockKernel>(this->Pool(), clock, this->Sources_.scales);
    } catch (const Error& error) {
      if (error.GetKind() != Error::Kind::Unsupported) { // that one where it is used
        throw;
      }
    }
  }
  // Loops among fixed frames are found now, others when they are met.
  for (const auto& [id, link] : this->Fixed_) {
    std::vector<int> seen = {id};
    for (auto next = this->Fixed_.find(link.base); next != this->Fixed_.end();
         next = this->Fixed_.find(next->second.base)) {
      if (std::find(seen.begin(), seen.end(), next->first) != seen.end()) {
        std::string loop;
        for (const int frame : seen) {
          loop += this->FrameName(frame) + " -> ";
        }
        Reject(Label(this->Table_.Get(next->first)), "its definition is a loop: " + loop +
                                                         this->FrameName(next->first) +
                                                         "; accepted: frames that lead to J2000");
      }
      seen.push_back(next->first);
    }
  }
}

Frames::~Frames() = default;

Frames::Link Frames::TkLink(const FrameInfo& info) const {
  const KernelPool& pool = this->Pool();
  std::string key = std::to_string(info.id);
  if (!pool.Has("TKFRAME_" + key + "_SPEC")) {
    key = info.name;
  }
  const auto name = [&](const char* item) { return "TKFRAME_" + key + "_" + item; };
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::Corrupt, Label(info), "kernel variable " + what);
  };
  for (const char* item : {"SPEC", "RELATIVE"}) {
    if (!pool.Has(name(item))) {
      fail(name(item) + " is missing");
    }
  }
  Link link;
  const std::string& relative = pool.Text(name("RELATIVE"));
  const FrameInfo* base = this->Table_.Find(relative);
  if (!base) {
    const std::string near = NearMatches(relative, this->Table_.Names());
    throw Error(Error::Kind::NotFound, Label(info),
                "it is relative to frame '" + relative + "', which is not known" +
                    (near.empty() ? "" : "; close to it: " + near));
  }
  link.base = base->id;
  link.source = "frame kernel '" + pool.Find(name("SPEC"))->file + "'";
  link.accuracy = "fixed";
  const std::string& spec = pool.Text(name("SPEC"));
  Eigen::Matrix3d toBase = Eigen::Matrix3d::Identity();
  if (spec == "MATRIX") {
    const std::vector<double>& m = pool.Numbers(name("MATRIX"), 9);
    toBase = Eigen::Map<const Eigen::Matrix3d>(m.data()); // column by column
    if (!((toBase.transpose() * toBase - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <
          1e-4) ||
        toBase.determinant() < 0.0) {
      fail(name("MATRIX") + " is no rotation within 1e-4");
    }
    // Kernels round their numbers: the nearest rotation.
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(toBase, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Eigen::Matrix3d exact = svd.matrixU() * svd.matrixV().transpose();
    if ((exact - toBase).cwiseAbs().maxCoeff() > 1e-15) {
      toBase = exact;
    }
  } else if (spec == "ANGLES") {
    const std::vector<double>& angles = pool.Numbers(name("ANGLES"), 3);
    const std::vector<double>& axes = pool.Numbers(name("AXES"), 3);
    const double unit = AngleUnit(pool.Text(name("UNITS")), name("UNITS"));
    for (std::size_t i = 0; i < 3; ++i) {
      if (axes[i] != 1.0 && axes[i] != 2.0 && axes[i] != 3.0) {
        fail(name("AXES") + " has " + NumberText(axes[i]) + "; accepted: 1, 2 and 3");
      }
      toBase = toBase * AxisTurn(angles[i] * unit, int(axes[i]));
    }
  } else if (spec == "QUATERNION") {
    const std::vector<double>& q = pool.Numbers(name("Q"), 4);
    const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
    if (!(std::abs(rotation.norm() - 1.0) < 1e-4)) {
      fail(name("Q") + " has the norm " + NumberText(rotation.norm()) + "; accepted: 1");
    }
    toBase = rotation.normalized().toRotationMatrix();
  } else {
    fail(name("SPEC") + " is '" + spec + "'; accepted: MATRIX, ANGLES or QUATERNION");
  }
  link.turn.rotation = toBase.transpose();
  return link;
}

Frames::Link Frames::MoonLink(const FrameInfo& info, double tdb) const {
  Link link;
  link.base = FrameJ2000;
  std::optional<De405Source::Libration> libration;
  if (this->Sources_.de405) {
    libration = this->Sources_.de405->LibrationAt(tdb);
  }
  if (!libration) {
    if (info.id == FrameMoonPa) {
      throw Error(Error::Kind::NotFound, Label(info),
                  "at " + TimeLabel(tdb, this->Sources_.scales) +
                      " neither a lunar frame kernel with its binary PCK nor DE405 (1960 to 2060, "
                      "package casacore-data-jpl-de405) gives the Moon's libration; accepted: one "
                      "of them, or IAU_MOON");
    }
    link.turn = BodyRotation(this->Pool(), 301, tdb).turn;
    link.source = "IAU_MOON in place of MOON_ME";
    link.accuracy = "within 155 m on the ground: the IAU's series of the libration";
    link.warning = Label(info) + " is taken from IAU_MOON, " + link.accuracy +
                   "; load a lunar frame kernel with its binary PCK, or install Debian's "
                   "casacore-data-jpl-de405 (1960 to 2060)";
    return link;
  }
  const Eigen::Vector3d& angle = libration->angles;
  const Eigen::Vector3d& rate = libration->rates;
  link.turn = PoleTurn(angle[0], rate[0], angle[1], rate[1], angle[2], rate[2]);
  link.source = this->Sources_.de405->Name() + " libration";
  if (info.id == FrameMoonMe) {
    StateTurn toMe;
    toMe.rotation = De405MeFromPa();
    link.turn = toMe * link.turn;
    link.source += " and a fitted turn from principal to mean Earth axes";
    link.accuracy = "MOON_ME of DE421 within 0.28 arcsec (2.4 m on the ground) from 1960 to 2050";
  } else {
    link.accuracy = "DE405's own principal axes, which differ from DE421's by up to 5.5 arcsec "
                    "(46 m on the ground)";
  }
  return link;
}

std::optional<Frames::Link> Frames::MoonStandIn(const FrameInfo& info, double tdb) const {
  if (info.center != BodyMoon) {
    return std::nullopt;
  }
  for (const auto& [id, fixed] : this->Fixed_) {
    const FrameInfo& mean = this->Table_.Get(id);
    if (fixed.base != info.id || mean.name.rfind("MOON_ME", 0) != 0) {
      continue;
    }
    FrameInfo builtIn = info;
    builtIn.id = FrameMoonMe;
    Link link = this->MoonLink(builtIn, tdb);
    StateTurn toPrincipal;
    toPrincipal.rotation = fixed.turn.rotation.transpose();
    link.turn = toPrincipal * link.turn;
    link.source += " and the turn of " + fixed.source;
    return link;
  }
  return std::nullopt;
}

Frames::Link Frames::PckLink(const FrameInfo& info, double tdb) const {
  Link link;
  std::vector<std::pair<double, double>> spans;
  const auto& files = this->Sources_.orientations;
  for (auto file = files.rbegin(); file != files.rend(); ++file) {
    const std::vector<BinaryPck::Segment>& segments = (*file)->Segments();
    for (std::size_t i = segments.size(); i-- > 0;) {
      const BinaryPck::Segment& segment = segments[i];
      if (segment.frameClass != info.classId) {
        continue;
      }
      spans.emplace_back(segment.begin, segment.end);
      if (tdb < segment.begin || tdb > segment.end) {
        continue;
      }
      const BinaryPck::Angles a = (*file)->At(i, tdb);
      link.base = segment.inertial;
      link.turn = PoleTurn(a.phi, a.phiRate, a.delta, a.deltaRate, a.w, a.wRate);
      link.source = "binary PCK " + FileName((*file)->File());
      return link;
    }
  }
  const bool hasElements = HasBodyRotation(this->Pool(), info.classId);
  if (!spans.empty() && !hasElements && info.id != FrameItrf93) {
    if (std::optional<Link> moon = this->MoonStandIn(info, tdb)) {
      moon->warning = Label(info) + " is taken from " + moon->source + ", " + moon->accuracy +
                      ", outside of what the loaded binary PCKs cover: " +
                      SpansText(spans, this->Sources_.scales);
      return *moon;
    }
    Reject(Label(info), "the time is " + TimeLabel(tdb, this->Sources_.scales) +
                            "; the binary PCKs cover " + SpansText(spans, this->Sources_.scales));
  }
  const auto warn = [&] {
    if (!spans.empty()) {
      link.warning = Label(info) + " is taken from " + link.source +
                     (link.accuracy.empty() ? "" : ", " + link.accuracy) +
                     ", outside of what the loaded binary PCKs cover: " +
                     SpansText(spans, this->Sources_.scales);
    }
  };
  if (info.id == FrameMoonPa || info.id == FrameMoonMe) {
    if (info.kernel.empty()) {
      link = this->MoonLink(info, tdb);
      warn();
      return link;
    }
  } else if (info.id == FrameItrf93) {
    link.base = FrameJ2000;
    const EarthOrientation* earth = this->Sources_.earth.get();
    link.turn = EarthRotation(tdb, this->Sources_.scales, earth);
    link.source = "ERFA's IAU 2006/2000A precession and nutation";
    link.accuracy = EarthRotationAccuracy(tdb, this->Sources_.scales, earth);
    warn();
    return link;
  }
  if (!hasElements) {
    throw Error(Error::Kind::NotFound, Label(info),
                "its orientation is not known; accepted: a binary PCK with frame class " +
                    std::to_string(info.classId) + ", or a text PCK with BODY" +
                    std::to_string(info.classId) + "_PM, loaded");
  }
  const BodyTurn body = BodyRotation(this->Pool(), info.classId, tdb);
  link.base = body.base;
  link.turn = body.turn;
  link.source = body.source;
  link.accuracy = info.classId == 301   ? "within 155 m of MOON_ME on the ground"
                  : info.classId == 399 ? "within 0.2 deg before 2050: no nutation, UT1 of 2000"
                                        : "as the IAU's report states";
  warn();
  return link;
}

int Frames::ClockOf(int structure) const {
  const std::string variable = "CK_" + std::to_string(structure) + "_SCLK";
  return this->Pool().Has(variable) ? this->Pool().Integer(variable) : structure / 1000;
}

Frames::Link Frames::CkLink(const FrameInfo& info, double tdb) const {
  const int clockId = this->ClockOf(info.classId);
  const auto found = this->Clocks_.find(clockId);
  if (found == this->Clocks_.end()) {
    const std::vector<int> clocks = ClockKernel::Clocks(this->Pool());
    if (std::find(clocks.begin(), clocks.end(), clockId) != clocks.end()) {
      const ClockKernel unsupported(this->Pool(), clockId, this->Sources_.scales); // throws
    }
    throw Error(Error::Kind::NotFound, Label(info),
                "its attitude needs the SCLK kernel of clock " + std::to_string(clockId) +
                    "; accepted: that kernel, loaded");
  }
  const ClockKernel& clock = *found->second;
  double ticks = 0.0;
  try {
    ticks = clock.TicksOf(tdb);
  } catch (const Error& error) {
    Reject(Label(info), error.what());
  }
  std::vector<std::pair<double, double>> spans;
  const auto& files = this->Sources_.attitudes;
  for (auto file = files.rbegin(); file != files.rend(); ++file) {
    const std::vector<CkFile::Segment>& segments = (*file)->Segments();
    for (std::size_t i = segments.size(); i-- > 0;) {
      const CkFile::Segment& segment = segments[i];
      if (segment.instrument != info.classId) {
        continue;
      }
      // TDB is rounded to 1e-5 ticks or so: the first and last pointing must still be found.
      constexpr double Rounding = 1e-3; // [ticks]
      const auto at = [&, &reader = **file](double time) {
        return time >= segment.begin - Rounding && time <= segment.end + Rounding
                   ? reader.At(i, time, Rounding)
                   : std::nullopt;
      };
      const std::optional<CkFile::Pointing> pointing = at(ticks);
      if (!pointing) {
        for (const auto& [begin, end] : (*file)->Intervals(i)) {
          spans.emplace_back(clock.TdbOf(begin), clock.TdbOf(end));
        }
        continue;
      }
      Link link;
      link.base = segment.frame;
      link.turn.rotation = pointing->rotation;
      link.source = "CK " + FileName((*file)->File());
      if (pointing->rate) {
        link.turn.rate = -pointing->rotation * Skew(*pointing->rate);
        return link;
      }
      // The interpolation turns at a constant rate about a fixed axis: two pointings give it.
      constexpr double Step = 0.05; // [s]
      for (const double step : {Step, -Step}) {
        const std::optional<CkFile::Pointing> next = at(clock.TicksOf(tdb + step));
        if (next) {
          const Eigen::AngleAxisd turn(
              Eigen::Matrix3d(next->rotation * pointing->rotation.transpose()));
          link.turn.rate = Skew(turn.axis() * turn.angle() / step) * pointing->rotation;
          return link;
        }
      }
      link.turn.rate.setConstant(std::numeric_limits<double>::quiet_NaN());
      return link;
    }
  }
  if (spans.empty()) {
    throw Error(Error::Kind::NotFound, Label(info),
                "no loaded CK has the attitude of structure " + std::to_string(info.classId) +
                    "; accepted: a CK with it, loaded");
  }
  Reject(Label(info), "the time is " + TimeLabel(tdb, this->Sources_.scales) + "; the CKs cover " +
                          SpansText(spans, this->Sources_.scales));
}

Frames::Link Frames::LinkOf(const FrameInfo& info, double tdb) const {
  switch (info.kind) {
  case FrameClass::Inertial: {
    if (info.id < 1 || info.id > InertialFrameCount) {
      throw Error(Error::Kind::Unsupported, Label(info),
                  "a kernel defines it as inertial (class 1); accepted: the inertial frames 1 to " +
                      std::to_string(InertialFrameCount) + ", which are built in");
    }
    Link link;
    link.base = FrameJ2000;
    link.turn.rotation = InertialRotation(info.id);
    link.source = "built in";
    link.accuracy = "exact by definition";
    return link;
  }
  case FrameClass::Pck:
    return this->PckLink(info, tdb);
  case FrameClass::Ck:
    return this->CkLink(info, tdb);
  case FrameClass::Tk: {
    const auto found = this->Fixed_.find(info.id);
    if (found == this->Fixed_.end()) {
      if (!info.kernel.empty()) {
        return this->TkLink(info);
      }
      throw Error(Error::Kind::NotFound, Label(info),
                  "no loaded frame kernel defines it (TKFRAME_" + info.name + "_SPEC)");
    }
    return found->second;
  }
  default:
    throw Error(Error::Kind::Unsupported, Label(info),
                std::string("it is a ") +
                    (info.kind == FrameClass::Dynamic ? "dynamic" : "switch") + " frame (class " +
                    std::to_string(int(info.kind)) +
                    "), which is not read; accepted: inertial, PCK, CK and TK frames");
  }
}

Frames::Chain Frames::ChainOf(int frame, int stop, double tdb) const {
  Chain chain;
  chain.frames.push_back(frame);
  while (frame != FrameJ2000 && frame != stop) {
    try {
      const FrameInfo& info = this->Table_.Get(frame);
      Link link = this->LinkOf(info, tdb);
      this->Table_.Get(link.base);
      if (std::find(chain.frames.begin(), chain.frames.end(), link.base) != chain.frames.end() ||
          chain.frames.size() >= LongestChain) {
        std::string loop;
        for (const int at : chain.frames) {
          loop += this->FrameName(at) + " -> ";
        }
        Reject(Label(info), "its definition is a loop: " + loop + this->FrameName(link.base) +
                                "; accepted: frames that lead to J2000");
      }
      frame = link.base;
      chain.frames.push_back(frame);
      chain.links.push_back(std::move(link));
    } catch (const Error&) {
      chain.broken = std::current_exception();
      return chain;
    }
  }
  return chain;
}

std::pair<Frames::Chain, Frames::Chain> Frames::Meet(int from, int to, double tdb) const {
  RequireFinite("frames", "the time", tdb);
  Chain up = this->ChainOf(from, to, tdb);
  if (up.frames.back() == to) {
    return {std::move(up), Chain{{to}, {}, nullptr}};
  }
  Chain down = this->ChainOf(to, from, tdb);
  for (std::size_t j = 0; j < down.frames.size(); ++j) {
    const auto common = std::find(up.frames.begin(), up.frames.end(), down.frames[j]);
    if (common != up.frames.end()) {
      const std::size_t i = std::size_t(common - up.frames.begin());
      up.frames.resize(i + 1);
      up.links.resize(i);
      down.frames.resize(j + 1);
      down.links.resize(j);
      return {std::move(up), std::move(down)};
    }
  }
  std::rethrow_exception(up.broken ? up.broken : down.broken);
}

StateTurn Frames::Turn(int from, int to, double tdb) const {
  this->Table_.Get(from);
  this->Table_.Get(to);
  if (from == to) {
    RequireFinite("frames", "the time", tdb);
    return {};
  }
  const auto [up, down] = this->Meet(from, to, tdb);
  StateTurn out; // from `from` to the frame in common
  for (const Link& link : up.links) {
    FallbackScope::Note(link.warning);
    out = link.turn.Inverse() * out;
  }
  for (auto link = down.links.rbegin(); link != down.links.rend(); ++link) {
    FallbackScope::Note(link->warning);
    out = link->turn * out;
  }
  return out;
}

StateTurn Frames::Turn(const std::string& from, const std::string& to, double tdb) const {
  return this->Turn(this->FrameId(from), this->FrameId(to), tdb);
}

Eigen::Matrix3d Frames::Rotation(const std::string& from, const std::string& to, double tdb) const {
  return this->Turn(from, to, tdb).rotation;
}

std::vector<Frames::Step> Frames::Explain(const std::string& from, const std::string& to,
                                          double tdb) const {
  const auto [up, down] = this->Meet(this->FrameId(from), this->FrameId(to), tdb);
  std::vector<Step> out;
  const auto add = [&](const Chain& chain, std::size_t i) {
    out.push_back({this->FrameName(chain.frames[i]), this->FrameName(chain.frames[i + 1]),
                   chain.links[i].source, chain.links[i].accuracy});
  };
  for (std::size_t i = 0; i < up.links.size(); ++i) {
    add(up, i);
  }
  for (std::size_t i = down.links.size(); i-- > 0;) {
    add(down, i);
  }
  return out;
}

int Frames::FrameId(const std::string& name) const {
  return this->Table_.Get(name).id;
}

std::string Frames::FrameName(int frame) const {
  const FrameInfo* info = this->Table_.Find(frame);
  return info ? info->name : "frame " + std::to_string(frame);
}

bool Frames::IsInertial(int frame) const {
  const FrameInfo& info = this->Table_.Get(frame);
  if (info.kind == FrameClass::Inertial) {
    return true;
  }
  const auto fixed = this->Fixed_.find(frame); // a fixed offset from an inertial frame
  return fixed != this->Fixed_.end() && this->IsInertial(fixed->second.base);
}

int Frames::Center(int frame) const {
  const FrameInfo& info = this->Table_.Get(frame);
  if (info.center == std::numeric_limits<int>::min()) {
    throw Error(Error::Kind::NotFound, Label(info),
                "the body at its centre is not known; accepted: a kernel that defines its name "
                "(NAIF_BODY_NAME), loaded");
  }
  return info.center;
}

} // namespace dspace
