// What the tests of wheel tracks share: rough ground, ruts, and their depth by other code.
#ifndef DSPACE_TEST_WHEELTRACKTESTSUPPORT_H
#define DSPACE_TEST_WHEELTRACKTESTSUPPORT_H

#include <algorithm>
#include <atomic>
#include <cmath>
#include <complex>
#include <random>

#include "FormulaPosts.h"

#include <dspace/tracks/TrackPosts.h>

namespace dspace::testing {

inline double Hills(double c, double r) {
  return 0.3 * std::sin(0.05 * c) * std::cos(0.04 * r);
}

// Counts what is read of it.
class CountedPosts : public FormulaPosts {
public:
  using FormulaPosts::FormulaPosts;
  void Read(const PostBlock& block, float* heights) const override {
    ++this->reads;
    FormulaPosts::Read(block, heights);
  }
  mutable std::atomic<int> reads{0};
};

constexpr double Post = 0.025; // [m]

inline Eigen::Affine2d PostToScene() {
  Eigen::Affine2d map = Eigen::Affine2d::Identity();
  map.linear() << Post, 0.0, 0.0, -Post;
  map.translation() << -10.0, 10.0;
  return map;
}

struct Ground {
  std::shared_ptr<CountedPosts> base;
  std::shared_ptr<WheelTracks> tracks;
  std::shared_ptr<TrackPosts> posts;
  explicit Ground(std::int64_t side = 801, FormulaPosts::Formula formula = Hills, int cells = 124,
                  const WheelTracksOptions& options = {})
      : base(std::make_shared<CountedPosts>(side, side, false, std::move(formula), cells)),
        tracks(std::make_shared<WheelTracks>("ground", options)),
        posts(std::make_shared<TrackPosts>(base, tracks, PostToScene())) {}
  std::vector<float> Read(int level, const PostSource& source) const {
    const int columns = int(this->base->GetLattice().ColumnsAt(level));
    const int rows = int(this->base->GetLattice().RowsAt(level));
    std::vector<float> heights(std::size_t(columns) * rows);
    source.Read({level, 0, 0, columns, rows}, heights.data());
    return heights;
  }
};

inline TrackProfile Rut() {
  TrackProfile profile;
  profile.width = 0.24;
  profile.wall = 0.06;
  profile.rimWidth = 0.1;
  profile.rimHeight = 0.02;
  profile.treadPitch = 0.2;
  profile.treadDepth = 0.015;
  return profile;
}

inline TrackAddition Stroke(const std::string& name, const TrackProfile& profile,
                            std::vector<TrackContact> contacts, bool exact = false) {
  TrackAddition addition;
  addition.name = name;
  addition.profile = profile;
  addition.contacts = std::move(contacts);
  addition.exact = exact;
  return addition;
}

// A wheel that wanders, sinks here and there, and slips.
inline std::vector<TrackContact> Wander(std::mt19937& random, int steps, bool headings) {
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<TrackContact> contacts;
  Eigen::Vector2d p(8.0 * unit(random), 8.0 * unit(random));
  double course = 3.0 * unit(random);
  double rolled = unit(random);
  for (int i = 0; i < steps; ++i) {
    TrackContact c;
    c.place = p;
    c.sinkage = 0.05 + 0.03 * unit(random);
    c.rolled = rolled;
    c.heading = headings ? course + 0.2 * unit(random) : TrackContact::Unknown;
    contacts.push_back(c);
    course += 0.5 * unit(random);
    p += 0.15 * Eigen::Vector2d(std::cos(course), std::sin(course));
    rolled += 0.17;
  }
  return contacts;
}

// By other code: complex numbers, and every line looked at. Less than -1: nothing is there.
inline double DepthAt(const std::vector<TrackStroke>& strokes, std::complex<double> q) {
  double deepest = -9.0;
  double nearest = 1e9; // of a rut's edge, and its rim's depth
  double rim = 0.0;
  for (const TrackStroke& stroke : strokes) {
    const TrackProfile& p = stroke.profile;
    for (std::size_t i = 0; i + 1 < stroke.contacts.size(); ++i) {
      const TrackContact& a = stroke.contacts[i];
      const TrackContact& b = stroke.contacts[i + 1];
      const std::complex<double> from(a.place.x(), a.place.y());
      const std::complex<double> to(b.place.x(), b.place.y());
      const std::complex<double> local = (q - from) / (to - from); // along: its real part
      const double t = std::min(1.0, std::max(0.0, local.real()));
      const std::complex<double> away = (local - t) * (to - from);
      const double d = std::abs(away) - p.width / 2;
      if (d > p.wall + p.rimWidth) {
        continue;
      }
      if (d > p.wall) {
        const double middle = d - p.wall - p.rimWidth / 2; // a parabola that is 0 at both ends
        if (d - p.wall < nearest) {
          nearest = d - p.wall;
          rim = p.rimHeight * (middle * middle * 4.0 / p.rimWidth / p.rimWidth - 1.0);
        }
        continue;
      }
      const auto unit = [&](double heading) {
        return std::isnan(heading) ? (to - from) / std::abs(to - from) : std::polar(1.0, heading);
      };
      std::complex<double> axis = (1.0 - t) * unit(a.heading) + t * unit(b.heading);
      axis /= std::abs(axis);
      const double s = (1.0 - t) * a.rolled + t * b.rolled + (away * std::conj(axis)).real();
      const double bar = std::pow(std::sin(M_PI * s / p.treadPitch), 2);
      const double floor = (1.0 - t) * a.sinkage + t * b.sinkage + p.treadDepth * bar;
      deepest = std::max(deepest, floor * std::min(1.0, (p.wall - d) / p.wall));
    }
  }
  return deepest < -1.0 && nearest < 1e9 ? rim : deepest;
}

} // namespace dspace::testing

#endif
