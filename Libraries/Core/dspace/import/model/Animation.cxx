// Key frames: PoseModel and DurationOf of Model.h.
#include <dspace/import/model/Model.h>

#include <algorithm>

namespace dspace {

namespace {

// Where a time lies between two keys.
struct Span {
  std::size_t key = 0; // the earlier one
  double length = 0.0; // [s]; 0: the key itself holds
  double part = 0.0;   // of the way to the next key, in [0, 1)
};

Span SpanAt(const std::vector<double>& times, double time) {
  const auto next = std::upper_bound(times.begin(), times.end(), time);
  if (next == times.begin() || next == times.end()) {
    return {next == times.begin() ? 0 : times.size() - 1, 0.0, 0.0};
  }
  const std::size_t key = std::size_t(next - times.begin()) - 1;
  const double length = *next - times[key];
  return {key, length, (time - times[key]) / length};
}

// The value of a channel: 3 numbers, or 4 of a rotation (x y z w, not yet of unit length).
Eigen::VectorXd ValueAt(const ModelChannel& channel, double time) {
  using Interpolation = ModelChannel::Interpolation;
  const Eigen::Index n = channel.property == ModelChannel::Property::Rotation ? 4 : 3;
  const bool cubic = channel.interpolation == Interpolation::CubicSpline;
  // Of CubicSpline each key has its in-tangent (0), value (1) and out-tangent (2).
  const auto at = [&](std::size_t key, std::size_t which) -> Eigen::VectorXd {
    const std::size_t element = cubic ? 3 * key + which : key;
    return Eigen::Map<const Eigen::VectorXd>(&channel.value[element * std::size_t(n)], n);
  };
  const Span span = SpanAt(channel.time_s, time);
  const Eigen::VectorXd from = at(span.key, 1);
  if (span.length == 0.0 || channel.interpolation == Interpolation::Step) {
    return from;
  }
  const Eigen::VectorXd to = at(span.key + 1, 1);
  const double t = span.part;
  if (cubic) {
    const double t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * from +
           span.length * (t3 - 2.0 * t2 + t) * at(span.key, 2) + (3.0 * t2 - 2.0 * t3) * to +
           span.length * (t3 - t2) * at(span.key + 1, 0);
  }
  if (n == 4) {
    return Eigen::Quaterniond(from.normalized().eval().data())
        .slerp(t, Eigen::Quaterniond(to.normalized().eval().data()))
        .coeffs();
  }
  return from + t * (to - from);
}

struct Parts {
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
  Eigen::Vector3d scale;
};

// An animated node is given by these in its file, so that its matrix is their product.
Parts PartsOf(const Eigen::Affine3d& local) {
  Parts parts;
  parts.translation = local.translation();
  parts.scale = local.linear().colwise().norm();
  if (local.linear().determinant() < 0.0) {
    parts.scale.x() = -parts.scale.x();
  }
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) {
    if (parts.scale[k] != 0.0) {
      rotation.col(k) = local.linear().col(k) / parts.scale[k];
    }
  }
  parts.rotation = Eigen::Quaterniond(rotation).normalized();
  return parts;
}

} // namespace

std::vector<Eigen::Affine3d> PoseModel(const Model& model, const ModelAnimation& animation,
                                       double time_s) {
  std::vector<Eigen::Affine3d> poses;
  std::vector<Parts> parts;
  for (const ModelNode& node : model.nodes) {
    poses.push_back(node.local);
    parts.push_back(PartsOf(node.local));
  }
  for (const ModelChannel& channel : animation.channels) {
    Parts& part = parts[std::size_t(channel.node)];
    const Eigen::VectorXd value = ValueAt(channel, time_s);
    switch (channel.property) {
    case ModelChannel::Property::Translation:
      part.translation = value;
      break;
    case ModelChannel::Property::Rotation:
      part.rotation = Eigen::Quaterniond(value.data()).normalized();
      break;
    case ModelChannel::Property::Scale:
      part.scale = value;
      break;
    }
    poses[std::size_t(channel.node)] =
        Eigen::Translation3d(part.translation) * part.rotation * Eigen::Scaling(part.scale);
  }
  return poses;
}

double DurationOf(const ModelAnimation& animation) {
  double last = 0.0;
  for (const ModelChannel& channel : animation.channels) {
    last = std::max(last, channel.time_s.back());
  }
  return last;
}

} // namespace dspace
