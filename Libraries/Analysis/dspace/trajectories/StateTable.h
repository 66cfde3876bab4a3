// States at times, and states between them.
#ifndef DSPACE_TRAJECTORIES_STATE_TABLE_H
#define DSPACE_TRAJECTORIES_STATE_TABLE_H

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <dspace/trajectories/Trajectory.h>

namespace dspace {

// How a table is read between its times. The degree is that of the polynomial; as many states as it
// takes are chosen about the time, fewer on one side near the table's ends.
struct Interpolation {
  enum class Kind {
    Linear,   // 2 states; position and velocity each linear
    Lagrange, // degree + 1 states; position and velocity each by a polynomial of their own.
              // Without velocities: the derivative of the positions' polynomial
    Hermite   // (degree + 1) / 2 states; the polynomial has their positions and velocities
  };
  Kind kind = Kind::Hermite;
  int degree = 7; // 1 to 31; of Hermite odd

  // The states that one interpolation takes.
  std::size_t StatesNeeded() const;
};

// Hermite's and Lagrange's polynomials by divided differences and by Neville's scheme (J. Stoer, R.
// Bulirsch, "Introduction to Numerical Analysis", 2.1). At a table's own times the result is the
// state of the table (of Lagrange to rounding).
class StateTable : public Trajectory {
public:
  struct Content {
    std::vector<double> times;               // [s], ascending, no two equal
    std::vector<Eigen::Vector3d> positions;  // [m]
    std::vector<Eigen::Vector3d> velocities; // [m/s]; empty: unknown, Lagrange and Linear only
    Interpolation interpolation;
    TimeSpan useable = {-HUGE_VAL, HUGE_VAL}; // cut to the times
  };
  // Throws Error(InvalidArgument) naming `name` ("object 'EM1'") and the value: times that do not
  // ascend, fewer states than one interpolation takes, another number of positions or velocities,
  // values that are not finite or beyond 1e18 m, a degree out of range, no useable time.
  StateTable(std::string name, Content content);

  const std::string& Name() const { return this->Name_; }
  const Content& Get() const { return this->Content_; }
  TimeSpan Span() const override { return this->Span_; }
  State At(double time_s) const override;

private:
  std::size_t FirstFor(double time_s, std::size_t count) const;
  State Linear(double time_s) const;
  State Lagrange(double time_s) const;
  State Hermite(double time_s) const;

  std::string Name_;
  Content Content_;
  TimeSpan Span_;
};

// Several tables one after the other, as the blocks of a file. Where the end of one is the begin of
// the next, the later one has the state.
class JoinedTables : public Trajectory {
public:
  // In any order. Throws Error(InvalidArgument) naming `name`: no table, tables whose spans overlap
  // in more than a point.
  JoinedTables(std::string name, std::vector<std::shared_ptr<const StateTable>> tables);

  const std::vector<std::shared_ptr<const StateTable>>& Tables() const { return this->Tables_; }
  TimeSpan Span() const override;
  std::vector<TimeSpan> Parts() const override;
  State At(double time_s) const override;

private:
  std::string Name_;
  std::vector<std::shared_ptr<const StateTable>> Tables_; // ascending
};

} // namespace dspace

#endif
