#include <dspace/orientation/BodyConstants.h>

#include <cmath>
#include <string>
#include <vector>

#include <dspace/Error.h>
#include <dspace/orientation/AxisTurns.h>
#include <dspace/time/Days.h>

namespace dspace {
namespace {

// From make_body_constants.py.
constexpr const char* StandardText =
#include <dspace/orientation/BodyConstants.inc>
    ;

constexpr double Century = 36525.0 * DaySeconds;

std::string Variable(int body, const char* item) {
  return "BODY" + std::to_string(body) + "_" + item;
}

// The pool that has the body's variable; null: neither.
const KernelPool* PoolOf(const KernelPool& pool, int body, const char* item) {
  const std::string name = Variable(body, item);
  if (pool.Has(name)) {
    return &pool;
  }
  return StandardConstants().Has(name) ? &StandardConstants() : nullptr;
}

// A quantity and its rate a second.
struct Value {
  double value = 0.0;
  double rate = 0.0;
};

// c0 + c1 x + c2 x^2 + ..., x in `unit` seconds.
Value Polynomial(const double* c, std::size_t count, double seconds, double unit) {
  const double x = seconds / unit;
  Value out;
  for (std::size_t i = count; i-- > 0;) {
    out.rate = out.rate * x + out.value;
    out.value = out.value * x + c[i];
  }
  out.rate /= unit;
  return out;
}

// The body whose NUT_PREC_ANGLES the body's series use: the barycentre of its planet's system.
int SystemOf(int body) {
  if (body >= 100 && body <= 999) {
    return body / 100;
  }
  if (body >= 10000 && body <= 99999) {
    return body / 10000; // further moons: 55060 of Jupiter
  }
  return body;
}

// [deg]
std::vector<Value> SystemAngles(const KernelPool& pool, int system, double seconds) {
  std::vector<Value> out;
  const std::string name = Variable(system, "NUT_PREC_ANGLES");
  if (!pool.Has(name)) {
    return out;
  }
  const std::string degree = Variable(system, "MAX_PHASE_DEGREE");
  const int terms = (pool.Has(degree) ? pool.Integer(degree) : 1) + 1;
  const std::vector<double>& numbers = pool.Numbers(name);
  if (terms < 2 || terms > 10 || numbers.size() % std::size_t(terms) != 0) {
    throw Error(Error::Kind::Corrupt, "kernel variable '" + name + "'",
                "it has " + std::to_string(numbers.size()) +
                    " numbers; accepted: " + std::to_string(terms) + " for each angle");
  }
  for (std::size_t i = 0; i < numbers.size(); i += std::size_t(terms)) {
    out.push_back(Polynomial(&numbers[i], std::size_t(terms), seconds, Century));
  }
  return out;
}

Value Element(const KernelPool& pool, int body, const char* item, const char* series, bool cosine,
              const std::vector<Value>& angles, double seconds, double unit) {
  const std::vector<double>& numbers = pool.Numbers(Variable(body, item));
  if (numbers.empty() || numbers.size() > 10) {
    throw Error(Error::Kind::Corrupt, "kernel variable '" + Variable(body, item) + "'",
                "it has " + std::to_string(numbers.size()) + " numbers; accepted: 1 to 10");
  }
  Value out = Polynomial(numbers.data(), numbers.size(), seconds, unit);
  const std::string name = Variable(body, series);
  if (!pool.Has(name)) {
    return out;
  }
  const std::vector<double>& amplitudes = pool.Numbers(name);
  if (amplitudes.size() > angles.size()) {
    throw Error(Error::Kind::Corrupt, "kernel variable '" + name + "'",
                "it has " + std::to_string(amplitudes.size()) +
                    " amplitudes and the system of "
                    "body " +
                    std::to_string(SystemOf(body)) + " has " + std::to_string(angles.size()) +
                    " angles; accepted: at most as many");
  }
  for (std::size_t i = 0; i < amplitudes.size(); ++i) {
    const double angle = std::fmod(angles[i].value, 360.0) * Degree;
    const double rate = angles[i].rate * Degree;
    if (cosine) {
      out.value += amplitudes[i] * std::cos(angle);
      out.rate -= amplitudes[i] * std::sin(angle) * rate;
    } else {
      out.value += amplitudes[i] * std::sin(angle);
      out.rate += amplitudes[i] * std::cos(angle) * rate;
    }
  }
  return out;
}

} // namespace

const KernelPool& StandardConstants() {
  static const KernelPool pool = [] {
    KernelPool out;
    out.Add(TextKernel::Parse(StandardText, "pck00011 and gm_de440, as shipped"));
    return out;
  }();
  return pool;
}

Eigen::Vector3d BodyRadii(const KernelPool& pool, int body) {
  const KernelPool* found = PoolOf(pool, body, "RADII");
  if (!found) {
    throw Error(Error::Kind::NotFound, "body " + std::to_string(body),
                "its radii are not known; accepted: a body of pck00011, or a loaded kernel with " +
                    Variable(body, "RADII"));
  }
  const std::vector<double>& km = found->Numbers(Variable(body, "RADII"), 3);
  const Eigen::Vector3d radii = 1000.0 * Eigen::Vector3d(km[0], km[1], km[2]);
  if (!(radii.minCoeff() > 0.0)) {
    throw Error(Error::Kind::Corrupt, "kernel variable '" + Variable(body, "RADII") + "'",
                "a radius is not above 0");
  }
  return radii;
}

std::optional<double> BodyGm(const KernelPool& pool, int body) {
  const KernelPool* found = PoolOf(pool, body, "GM");
  if (!found) {
    return std::nullopt;
  }
  const double gm = 1e9 * found->Number(Variable(body, "GM"));
  return gm > 0.0 ? std::optional<double>(gm) : std::nullopt; // 0: too small to be measured
}

bool HasBodyRotation(const KernelPool& pool, int body) {
  return PoolOf(pool, body, "PM") != nullptr;
}

BodyTurn BodyRotation(const KernelPool& pool, int body, double tdb) {
  const KernelPool* constants = PoolOf(pool, body, "PM");
  if (!constants) {
    throw Error(
        Error::Kind::NotFound, "body " + std::to_string(body),
        "its rotation is not known; accepted: a body of pck00011, or a loaded kernel with " +
            Variable(body, "PM"));
  }
  BodyTurn out;
  out.source = constants == &pool ? "the loaded PCK" : "pck00011";
  const std::string frame = Variable(body, "CONSTANTS_REF_FRAME");
  if (constants->Has(frame)) {
    out.base = constants->Integer(frame);
  }
  const std::string epoch = Variable(body, "CONSTANTS_JED_EPOCH");
  const double seconds =
      constants->Has(epoch) ? tdb - (constants->Number(epoch) - J2000Julian) * DaySeconds : tdb;
  const std::vector<Value> angles = SystemAngles(*constants, SystemOf(body), seconds);
  const Value ra =
      Element(*constants, body, "POLE_RA", "NUT_PREC_RA", false, angles, seconds, Century);
  const Value dec =
      Element(*constants, body, "POLE_DEC", "NUT_PREC_DEC", true, angles, seconds, Century);
  const Value pm =
      Element(*constants, body, "PM", "NUT_PREC_PM", false, angles, seconds, DaySeconds);
  out.turn = PoleTurn((90.0 + ra.value) * Degree, ra.rate * Degree, (90.0 - dec.value) * Degree,
                      -dec.rate * Degree, std::fmod(pm.value, 360.0) * Degree, pm.rate * Degree);
  return out;
}

} // namespace dspace
