// Tables of states against closed-form orbits between their times.
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/trajectories/Orbit.h>
#include <dspace/trajectories/StateTable.h>

namespace dspace {
namespace {

constexpr double EarthMu = 398600.4418e9;

// An eccentric orbit whose states are known in closed form: by Kepler's equation, solved here with
// Newton's steps, and not by the code under test.
State OnEllipse(double t) {
  const double a = 8000e3;
  const double e = 0.15;
  const double n = std::sqrt(EarthMu / (a * a * a));
  const double m = n * t;
  double E = m;
  for (int i = 0; i < 50; ++i) {
    E -= (E - e * std::sin(E) - m) / (1.0 - e * std::cos(E));
  }
  const double b = a * std::sqrt(1.0 - e * e);
  const double rate = n / (1.0 - e * std::cos(E));
  return {{a * (std::cos(E) - e), b * std::sin(E), 0.0},
          {-a * std::sin(E) * rate, b * std::cos(E) * rate, 0.0}};
}

StateTable::Content Nodes(double step, int count, Interpolation by, bool velocities = true) {
  StateTable::Content content;
  content.interpolation = by;
  for (int i = 0; i < count; ++i) {
    const State state = OnEllipse(step * i);
    content.times.push_back(step * i);
    content.positions.push_back(state.position);
    if (velocities) {
      content.velocities.push_back(state.velocity);
    }
  }
  return content;
}

struct Errors {
  double position = 0.0;
  double velocity = 0.0;
};

// The largest errors at ten times the density of the nodes, over two hours.
Errors ErrorsOf(double step, Interpolation by, bool velocities = true) {
  const int count = int(7200.0 / step) + 1;
  const StateTable table("orbit", Nodes(step, count, by, velocities));
  Errors errors;
  for (int i = 0; i <= 10 * (count - 1); ++i) {
    const double t = std::min(step * i / 10.0, table.Span().end);
    const State state = table.At(t);
    const State truth = OnEllipse(t);
    errors.position = std::max(errors.position, (state.position - truth.position).norm());
    errors.velocity = std::max(errors.velocity, (state.velocity - truth.velocity).norm());
  }
  return errors;
}

using Kind = Interpolation::Kind;

TEST(StateTable, HermiteFollowsAnOrbitAtTenTimesTheDensityOfItsNodes) {
  const Errors errors = ErrorsOf(60.0, {Kind::Hermite, 7});
  EXPECT_LT(errors.position, 1e-5); // [m]
  EXPECT_LT(errors.velocity, 1e-6); // [m/s]
}

TEST(StateTable, LagrangeFollowsAnOrbitWithAndWithoutVelocities) {
  const Errors errors = ErrorsOf(60.0, {Kind::Lagrange, 9});
  EXPECT_LT(errors.position, 2e-3); // worst near the ends, where its nodes lie on one side
  EXPECT_LT(errors.velocity, 2e-6);
  const Errors derived = ErrorsOf(60.0, {Kind::Lagrange, 9}, false);
  EXPECT_EQ(derived.position, errors.position);
  EXPECT_LT(derived.velocity, 2e-4);
}

TEST(StateTable, LinearErrsByTheSagOfTheChord) {
  const double highest = EarthMu / std::pow(8000e3 * 0.85, 2); // acceleration at periapsis
  const double bound = highest * 60.0 * 60.0 / 8.0;
  const Errors errors = ErrorsOf(60.0, {Kind::Linear, 1});
  EXPECT_LT(errors.position, bound);
  EXPECT_GT(errors.position, 0.97 * bound); // reached at periapsis, where it begins
}

// An interpolation of degree n errs by h^(n + 1): a node less, or one too many on a side, shows.
TEST(StateTable, ErrorsShrinkWithTheOrderOfTheDegree) {
  for (const auto& [by, order] : {std::pair<Interpolation, double>{{Kind::Hermite, 3}, 4.0},
                                  {{Kind::Hermite, 5}, 6.0},
                                  {{Kind::Lagrange, 4}, 5.0},
                                  {{Kind::Lagrange, 5}, 6.0}}) {
    const double coarse = ErrorsOf(240.0, by).position;
    const double fine = ErrorsOf(120.0, by).position;
    EXPECT_NEAR(std::log2(coarse / fine), order, 0.45) << by.degree;
  }
}

// Uneven times: a polynomial of the degree is reproduced.
TEST(StateTable, PolynomialsOfTheDegreeAreExactAtUnevenTimes) {
  const auto at = [](double t) -> State {
    return {{1.0 + t * (2.0 + t * (-0.5 + t * 0.25)), t * t * t, 3.0 - t},
            {2.0 + t * (-1.0 + t * 0.75), 3.0 * t * t, -1.0}};
  };
  for (const Interpolation by :
       {Interpolation{Kind::Hermite, 3}, Interpolation{Kind::Lagrange, 3}}) {
    for (const bool velocities : {true, false}) {
      if (by.kind == Kind::Hermite && !velocities) {
        continue;
      }
      StateTable::Content content;
      content.interpolation = by;
      for (const double t : {0.0, 0.5, 2.0, 2.25, 4.0, 7.0}) {
        content.times.push_back(t);
        content.positions.push_back(at(t).position);
        if (velocities) {
          content.velocities.push_back(at(t).velocity);
        }
      }
      const StateTable table("cubic", content);
      for (double t = 0.0; t <= 7.0; t += 0.125) {
        EXPECT_LT((table.At(t).position - at(t).position).norm(), 1e-11) << t;
        // Lagrange's velocities are interpolated themselves: quadratics, exact too.
        EXPECT_LT((table.At(t).velocity - at(t).velocity).norm(), 1e-10) << t;
      }
    }
  }
}

TEST(StateTable, ItsOwnTimesGiveItsOwnStates) {
  for (const Interpolation by : {Interpolation{Kind::Hermite, 7}, Interpolation{Kind::Lagrange, 8},
                                 Interpolation{Kind::Linear, 1}}) {
    const StateTable table("orbit", Nodes(60.0, 40, by));
    for (int i = 0; i < 40; ++i) {
      EXPECT_LT((table.At(60.0 * i).position - OnEllipse(60.0 * i).position).norm(), 1e-8);
      EXPECT_LT((table.At(60.0 * i).velocity - OnEllipse(60.0 * i).velocity).norm(), 1e-11);
    }
  }
}

TEST(StateTable, BlocksFollowEachOther) {
  StateTable::Content first = Nodes(60.0, 20, {Kind::Hermite, 3});
  first.useable = {60.0, 600.0};
  StateTable::Content second = Nodes(60.0, 40, {Kind::Hermite, 3});
  for (Eigen::Vector3d& p : second.positions) {
    p.z() = 1000.0; // told from the first
  }
  second.useable = {600.0, 1200.0};
  const auto a = std::make_shared<const StateTable>("a", first);
  const auto b = std::make_shared<const StateTable>("b", second);
  const JoinedTables joined("file", {b, a});
  EXPECT_EQ(joined.Span().begin, 60.0);
  EXPECT_EQ(joined.Span().end, 1200.0);
  EXPECT_EQ(joined.At(599.0).position.z(), 0.0);
  EXPECT_EQ(joined.At(600.0).position.z(), 1000.0); // the later block has the shared time
  EXPECT_THROW(joined.At(59.0), Error);             // known, and not useable
  EXPECT_EQ(joined.Parts().size(), 2u);

  second.useable.begin = 599.0;
  const auto over = std::make_shared<const StateTable>("b", second);
  try {
    JoinedTables("file", {a, over});
    FAIL() << "blocks that overlap were accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("overlap"), std::string::npos) << error.what();
  }
  second.useable.begin = 700.0;
  const JoinedTables gap("file", {a, std::make_shared<const StateTable>("b", second)});
  try {
    gap.At(650.0);
    FAIL() << "a state within a gap";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("to 600.000 s, and from 700.000 s"), std::string::npos)
        << error.what();
  }
}

TEST(StateTable, RejectsWhatCannotBeInterpolated) {
  const auto rejected = [](const StateTable::Content& content, const char* words) {
    try {
      StateTable("table", content);
      FAIL() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find("table"), 0u) << error.what();
    }
  };
  const StateTable::Content good = Nodes(60.0, 8, {Kind::Hermite, 7});
  StateTable::Content c = good;
  c.times[3] = c.times[2];
  rejected(c, "ascending times");
  c = good;
  c.interpolation.degree = 17;
  rejected(c, "9 and more");
  c.interpolation.degree = 6;
  rejected(c, "odd");
  c.interpolation.degree = 33;
  rejected(c, "1 to 31");
  c = good;
  c.velocities.clear();
  rejected(c, "no velocities");
  c = good;
  c.positions.pop_back();
  rejected(c, "as many of each");
  c = good;
  c.positions[1].x() = NAN;
  rejected(c, "position");
  c = good;
  c.velocities[1].x() = INFINITY;
  rejected(c, "velocity");
  c = good;
  c.useable = {1e6, 2e6};
  rejected(c, "useable");
  const StateTable table("table", good);
  EXPECT_THROW(table.At(-1e-6), Error);
  EXPECT_THROW(table.At(420.1), Error);
  EXPECT_THROW(table.At(NAN), Error);
}

} // namespace
} // namespace dspace
