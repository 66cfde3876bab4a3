// The body that a coordinate reference system lies on.
#ifndef DSPACE_SESSION_TERRAIN_BODY_H
#define DSPACE_SESSION_TERRAIN_BODY_H

#include <functional>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace dspace {
class Crs;
class KernelSet;
} // namespace dspace

namespace dspace::session {

// Its NAIF id, by its name or by its radius; none: the CRS tells no body. A body whose radii the
// kernels have wrong is not found by its radius.
std::optional<int> FindBody(const KernelSet& kernels, const Crs& crs);
// The same. Throws Error(InvalidArgument) that names `label` where it tells none.
int BodyOf(const KernelSet& kernels, const Crs& crs, const std::string& label);
// The body that a command names, or BodyOf() where it names none (""). `warn` gets a sentence where
// the CRS tells another body. Throws Error: NotFound for an unknown name, and what BodyOf throws.
int BodyFor(const KernelSet& kernels, const Crs& crs, const std::string& named,
            const std::string& label, const std::function<void(const std::string&)>& warn);

// The rotation from the axes of this body (as BodyFixed of FrameTable.h names them) to J2000 at a
// time [s past J2000 TDB]. None: the CRS tells no body, or how it turns is not known then.
std::optional<Eigen::Matrix3d> InertialFromFixed(const KernelSet& kernels, const Crs& crs,
                                                 double tdb);

} // namespace dspace::session

#endif
