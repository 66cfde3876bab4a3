#include <dspace/camera/ConvertModel.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <Eigen/Cholesky>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int Side = 41;
constexpr int Steps = 200;
constexpr double WidestPlane = 80.0 * M_PI / 180.0; // from the axis, of lenses that distort a plane

struct Sample {
  Eigen::Vector2d pixel;
  Eigen::Vector3d direction;
};

// The numbers of a type as one list, and back.
struct Family {
  Eigen::VectorXd start;
  std::function<LensValues(const Eigen::VectorXd&)> values;
};

using Numbers = std::vector<double>;

Numbers Part(const Eigen::VectorXd& x, int first, int count) {
  return Numbers(x.data() + first, x.data() + first + count);
}

// `f`: pixels per radian at the axis; `c`: the axis' pixel.
Family FamilyOf(const std::string& type, const Eigen::Vector2d& f, const Eigen::Vector2d& c,
                const std::string& label) {
  Family family;
  const auto start = [&](int more) {
    family.start = Eigen::VectorXd::Zero(4 + more);
    family.start.head<4>() << f, c;
  };
  const auto plain = [](const Eigen::VectorXd& x) {
    return LensValues{{"focal", Part(x, 0, 2)}, {"center", Part(x, 2, 2)}};
  };
  if (type == "pinhole" || type == "equidistant") {
    start(0);
    family.values = plain;
  } else if (type == "brown") {
    start(8);
    family.values = [plain](const Eigen::VectorXd& x) {
      LensValues v = plain(x);
      v["radial"] = Part(x, 4, 6);
      v["tangential"] = Part(x, 10, 2);
      return v;
    };
  } else if (type == "kannala_brandt") {
    start(4);
    family.values = [plain](const Eigen::VectorXd& x) {
      LensValues v = plain(x);
      v["radial"] = Part(x, 4, 4);
      return v;
    };
  } else if (type == "ucm" || type == "eucm" || type == "double_sphere") {
    start(type == "ucm" ? 1 : 2);
    family.start[4] = 0.5;
    if (type != "ucm") {
      family.start[5] = type == "eucm" ? 1.0 : 0.0;
    }
    family.values = [plain, type](const Eigen::VectorXd& x) {
      LensValues v = plain(x);
      v["alpha"] = {x[4]};
      if (type != "ucm") {
        v[type == "eucm" ? "beta" : "xi"] = {x[5]};
      }
      return v;
    };
  } else if (type == "owen") {
    family.start = Eigen::VectorXd::Zero(12);
    family.start.head<6>() << f.x(), 0.0, 0.0, f.y(), c;
    family.values = [](const Eigen::VectorXd& x) {
      return LensValues{{"focal_length", {1.0}},       {"matrix", Part(x, 0, 4)},
                        {"center", Part(x, 4, 2)},     {"radial", Part(x, 6, 2)},
                        {"tangential", Part(x, 8, 2)}, {"pinwheel", Part(x, 10, 2)}};
    };
  } else if (type == "cahv" || type == "cahvor" || type == "cahvore") {
    const int more = type == "cahv" ? 0 : 5;
    family.start = Eigen::VectorXd::Zero(5 + more);
    family.start.head<5>() << f.x(), c.x(), 0.0, f.y(), c.y();
    family.values = [type](const Eigen::VectorXd& x) {
      LensValues v{{"A", {0, 0, 1}}, {"H", {x[0], 0, x[1]}}, {"V", {x[2], x[3], x[4]}}};
      if (type != "cahv") {
        const Eigen::Vector3d O = Eigen::Vector3d(x[5], x[6], 1.0).normalized();
        v["O"] = {O[0], O[1], O[2]};
        v["R"] = Part(x, 7, 3);
      }
      if (type == "cahvore") {
        v["E"] = {0, 0, 0};
        v["linearity"] = {0.0};
      }
      return v;
    };
  } else {
    throw Error(Error::Kind::Unsupported, label,
                "the type '" + type +
                    "' cannot be fitted; accepted: brown, cahv, cahvor, cahvore, "
                    "double_sphere, equidistant, eucm, kannala_brandt, owen, "
                    "pinhole, ucm");
  }
  return family;
}

// Errors in pixels, two for each sample; false where the numbers are no lens that sees them all.
bool ErrorsOf(const std::string& type, const LensValues& values, const std::vector<Sample>& samples,
              Eigen::VectorXd& errors) {
  LensPtr lens;
  try {
    lens = MakeLens(type, values, "fitted lens");
  } catch (const Error&) {
    return false;
  }
  errors.resize(Eigen::Index(2 * samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    Eigen::Vector2d pixel;
    if (!lens->Project(samples[i].direction, pixel)) {
      return false;
    }
    errors.segment<2>(Eigen::Index(2 * i)) = pixel - samples[i].pixel;
  }
  return errors.allFinite();
}

Eigen::VectorXd Fit(const std::string& type, const Family& family,
                    const std::vector<Sample>& samples, const std::string& label) {
  Eigen::VectorXd x = family.start, errors;
  if (!ErrorsOf(type, family.values(x), samples, errors)) {
    Reject(label, "a lens of type " + type +
                      " cannot see its field; accepted: a type for its field "
                      "of view");
  }
  double damping = 1e-3;
  for (int step = 0; step < Steps; ++step) {
    Eigen::MatrixXd J(errors.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double h = 1e-6 * std::max(std::abs(x[k]), 1e-2);
      Eigen::VectorXd moved = x, there, back;
      moved[k] = x[k] + h;
      const bool ahead = ErrorsOf(type, family.values(moved), samples, there);
      moved[k] = x[k] - h;
      const bool behind = ErrorsOf(type, family.values(moved), samples, back);
      if (!ahead && !behind) {
        return x;
      }
      J.col(k) =
          ((ahead ? there : errors) - (behind ? back : errors)) / (ahead && behind ? 2.0 * h : h);
    }
    const Eigen::MatrixXd square = J.transpose() * J;
    const Eigen::VectorXd slope = J.transpose() * errors;
    bool better = false;
    double gain = 0.0;
    for (; damping < 1e12; damping *= 4.0) {
      Eigen::MatrixXd damped = square;
      damped.diagonal() += damping * square.diagonal().cwiseMax(1e-12);
      const Eigen::VectorXd next = x - damped.ldlt().solve(slope);
      Eigen::VectorXd there;
      if (next.allFinite() && ErrorsOf(type, family.values(next), samples, there) &&
          there.squaredNorm() < errors.squaredNorm()) {
        gain = 1.0 - there.squaredNorm() / errors.squaredNorm();
        x = next;
        errors = there;
        better = true;
        break;
      }
    }
    damping = std::max(damping / 8.0, 1e-12);
    if (!better || gain < 1e-10) {
      return x;
    }
  }
  return x;
}

} // namespace

ConvertedModel ConvertModel(const CameraModel& from, const std::string& type) {
  const std::string label = from.Label();
  if (from.width < 1 || from.height < 1) {
    Reject(label,
           "it does not say for which size of image it is; accepted: a model that does, to be "
           "converted");
  }
  ConvertedModel to;
  to.model = from;
  if (std::string(from.lens->Type()) == "orthographic" && type != "orthographic") {
    throw Error(Error::Kind::Unsupported, label, "its rays are parallel; accepted: another model");
  }
  if (std::string(from.lens->Type()) == "line_scan" && type != "line_scan") {
    throw Error(Error::Kind::Unsupported, label, "its row moves; accepted: another model");
  }
  if (type == from.lens->Type()) {
    to.covered = 1.0;
    return to;
  }
  const bool plane =
      type == "brown" || type == "owen" || type == "pinhole" || type == "cahv" || type == "cahvor";
  std::vector<Sample> samples;
  int seen = 0;
  for (int j = 0; j < Side; ++j) {
    for (int i = 0; i < Side; ++i) {
      const Eigen::Vector2d pixel((from.width - 1.0) * i / (Side - 1),
                                  (from.height - 1.0) * j / (Side - 1));
      LensRay ray;
      if (from.lens->Unproject(pixel, ray)) {
        ++seen;
        to.pupilShift = std::max(to.pupilShift, ray.origin.norm());
        const double angle = std::atan2(ray.direction.head<2>().norm(), ray.direction.z());
        if (!plane || angle <= WidestPlane) {
          samples.push_back({pixel, ray.direction});
        }
      }
    }
  }
  Eigen::Vector2d center;
  LensModel::Jacobian jacobian;
  if (samples.size() < 20 || !from.lens->Project(Eigen::Vector3d::UnitZ(), center, &jacobian)) {
    Reject(label, "too little of its image lies in its field, or its axis does not; accepted: a "
                  "model that sees along its axis");
  }
  const Family family = FamilyOf(
      type, Eigen::Vector2d(jacobian.row(0).norm(), jacobian.row(1).norm()), center, label);
  const Eigen::VectorXd x = Fit(type, family, samples, label);
  Eigen::VectorXd errors;
  ErrorsOf(type, family.values(x), samples, errors);
  to.model.lens = MakeLens(type, family.values(x), label);
  to.rms = std::sqrt(errors.squaredNorm() / double(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    to.greatest = std::max(to.greatest, errors.segment<2>(Eigen::Index(2 * i)).norm());
  }
  to.covered = double(samples.size()) / std::max(seen, 1);
  return to;
}

} // namespace dspace
