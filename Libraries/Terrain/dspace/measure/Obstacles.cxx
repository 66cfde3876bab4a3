#include <dspace/measure/Obstacles.h>

#include <dspace/Checks.h>

namespace dspace {

void Obstacles::Add(std::uint32_t object, std::shared_ptr<const MeshRays> rays,
                    const Eigen::Affine3d& X_RM, double albedo) {
  if (rays && !rays->IsEmpty()) {
    this->Solids_.push_back({object, std::move(rays), X_RM, X_RM.inverse(), albedo});
  }
}

double Obstacles::HeightOver(const Ground& ground, const Eigen::Vector3d& p_S) {
  const SurfaceSample sample = ground.surface->Sample(p_S);
  return sample.valid ? ground.X_RS.scale * (p_S - sample.position_S).dot(ground.surface->Up(p_S))
                      : std::numeric_limits<double>::quiet_NaN();
}

Eigen::Vector3d Obstacles::Stand(const Ground& ground, const Eigen::Vector3d& p_R,
                                 const std::string& label) const {
  const Eigen::Vector3d p_S = ground.X_RS.Inverse().Apply(p_R);
  const double height = HeightOver(ground, p_S);
  // Places come from additions in the root, whose coordinates may be large.
  const double rounding = 16.0 * std::numeric_limits<double>::epsilon() *
                          (p_R.cwiseAbs().maxCoeff() + p_S.cwiseAbs().maxCoeff());
  const double touch = Touch + rounding;
  if (height < -touch) {
    Reject(label, "it is " + NumberText(-height) + " m below the ground of terrain '" +
                      ground.name + "'; accepted: places on or above the ground");
  }
  return height < touch
             ? Eigen::Vector3d(p_S + (touch - height) / ground.X_RS.scale * ground.surface->Up(p_S))
             : p_S;
}

Obstacles::Hit Obstacles::First(const Eigen::Vector3d& from_R, const Eigen::Vector3d& to_R,
                                const std::string& fromLabel, const std::string& toLabel) const {
  Hit first;
  const double range = (to_R - from_R).norm();
  for (const Ground& ground : this->Grounds_) {
    this->Check();
    const Eigen::Vector3d from_S = this->Stand(ground, from_R, fromLabel);
    const Eigen::Vector3d to_S = this->Stand(ground, to_R, toLabel);
    const Eigen::Vector3d line_S = to_S - from_S;
    const double length = line_S.norm();
    if (length == 0.0) {
      continue;
    }
    const RayHit found = ground.surface->Intersect(from_S, line_S, length);
    const double distance = ground.X_RS.scale * found.distance;
    if (found.hit && distance < first.distance) {
      first = {true, ground.name, 0, distance, ground.X_RS.Apply(found.position_S)};
    }
  }
  const double touch = Touch / range;
  for (const Solid& solid : this->Solids_) {
    const Eigen::Vector3d direction_M = solid.X_MR.linear() * (to_R - from_R);
    const double t = solid.rays->Intersect(solid.X_MR * from_R, direction_M, touch, 1.0 - touch);
    if (t * range < first.distance) {
      first = {true, {}, solid.id, t * range, from_R + t * (to_R - from_R)};
    }
  }
  return first;
}

Obstacles::Start Obstacles::StartAt(const Eigen::Vector3d& p_R, const std::string& label) const {
  Start start{p_R, {}};
  for (const Ground& ground : this->Grounds_) {
    start.p_S.push_back(this->Stand(ground, p_R, label));
  }
  return start;
}

Obstacles::Met Obstacles::Meet(const Start& start, const Eigen::Vector3d& direction_R,
                               double most) const {
  this->Check();
  Met met;
  for (std::size_t i = 0; i < this->Grounds_.size(); ++i) {
    const Ground& ground = this->Grounds_[i];
    const double scale = ground.X_RS.scale;
    const RayHit found = ground.surface->Intersect(
        start.p_S[i], ground.X_RS.rotation.conjugate() * direction_R, most / scale);
    const double distance = scale * found.distance;
    if (found.hit && distance < met.distance) {
      met = {&ground, nullptr, distance, ground.X_RS.rotation * found.normal_S};
    }
  }
  for (const Solid& solid : this->Solids_) {
    const Eigen::Matrix3d toSolid = solid.X_MR.linear();
    const MeshRays::Crossing found = solid.rays->Cross(
        solid.X_MR * start.p_R, toSolid * direction_R, Touch, std::min(most, met.distance));
    if (found.t < met.distance) {
      met = {nullptr, &solid, found.t, (toSolid.transpose() * found.normal_M).normalized()};
    }
  }
  return met;
}

} // namespace dspace
