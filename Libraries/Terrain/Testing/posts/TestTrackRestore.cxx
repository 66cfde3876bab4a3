// Tracks that are given out and taken back: the same to the bit, then and later.
#include <cstring>

#include <gtest/gtest.h>

#include "WheelTrackTestSupport.h"

#include <dspace/Error.h>

namespace dspace::testing {
namespace {

bool SameBits(double a, double b) {
  return std::memcmp(&a, &b, sizeof(a)) == 0;
}

void ExpectSame(const std::vector<TrackContact>& a, const std::vector<TrackContact>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(SameBits(a[i].place.x(), b[i].place.x()) &&
                SameBits(a[i].place.y(), b[i].place.y()) && SameBits(a[i].rolled, b[i].rolled) &&
                SameBits(a[i].heading, b[i].heading) && SameBits(a[i].sinkage, b[i].sinkage))
        << i;
  }
}

void ExpectSamePosts(const Ground& a, const Ground& b) {
  for (int level = 0; level < a.base->GetLattice().levels; ++level) {
    const std::vector<float> here = a.Read(level, *a.posts);
    const std::vector<float> there = b.Read(level, *b.posts);
    ASSERT_EQ(std::memcmp(here.data(), there.data(), here.size() * sizeof(float)), 0) << level;
  }
}

// In every answer.
void ExpectSame(const Ground& a, const Ground& b) {
  const std::vector<TrackStroke> first = a.tracks->Strokes();
  const std::vector<TrackStroke> second = b.tracks->Strokes();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].name, second[i].name);
    EXPECT_TRUE(first[i].profile == second[i].profile);
    ExpectSame(first[i].contacts, second[i].contacts);
    ExpectSame(first[i].skipped, second[i].skipped);
  }
  EXPECT_EQ(a.tracks->Statistics().bytes, b.tracks->Statistics().bytes);
  EXPECT_EQ(a.tracks->Statistics().length, b.tracks->Statistics().length);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-60.0, 60.0);
  std::uniform_real_distribution<double> size(-3.0, 6.0);
  int reached = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d corner(place(random), place(random));
    const Eigen::AlignedBox2d box(corner,
                                  corner + Eigen::Vector2d::Constant(std::exp(size(random))));
    ASSERT_EQ(a.tracks->Reaches(box), b.tracks->Reaches(box)) << i;
    reached += a.tracks->Reaches(box) ? 1 : 0;
  }
  EXPECT_GT(reached, 100);
  EXPECT_LT(reached, 1900);
}

// Some millimetres a contact, as a simulation gives them: most are left out.
class Rover {
public:
  explicit Rover(unsigned seed) : Random_(seed) {}
  std::vector<TrackAddition> Step(bool begin) {
    this->Course_ += 0.02 * this->Unit_(this->Random_);
    this->Place_ += 0.004 * Eigen::Vector2d(std::cos(this->Course_), std::sin(this->Course_));
    this->Sinkage_ = std::clamp(this->Sinkage_ + 1e-4 * this->Unit_(this->Random_), 0.0, 0.3);
    std::vector<TrackAddition> wheels;
    for (const double side : {-0.4, 0.4}) {
      TrackContact contact;
      contact.place =
          this->Place_ + side * Eigen::Vector2d(-std::sin(this->Course_), std::cos(this->Course_));
      contact.sinkage = this->Sinkage_;
      contact.heading = side < 0 ? this->Course_ : TrackContact::Unknown;
      wheels.push_back(Stroke(side < 0 ? "right" : "left", Rut(), {contact}));
      wheels.back().begin = begin;
    }
    return wheels;
  }

private:
  std::mt19937 Random_;
  std::uniform_real_distribution<double> Unit_{-1.0, 1.0};
  Eigen::Vector2d Place_{-4.0, -4.0};
  double Course_ = 0.5;
  double Sinkage_ = 0.05;
};

TEST(TrackRestore, IsTheSameToTheBitAndGoesOnAlike) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Ground first;
    Rover rover(seed);
    for (int i = 0; i < 1501; ++i) {
      first.tracks->Add(rover.Step(i % 600 == 0));
    }
    const std::vector<TrackStroke> strokes = first.tracks->Strokes();
    ASSERT_EQ(strokes.size(), 6u);
    EXPECT_GT(strokes[4].skipped.size() + strokes[5].skipped.size(), 0u);
    Ground whole;
    whole.tracks->Restore(strokes);
    ExpectSame(first, whole);
    Ground parted; // each stroke in parts of two contacts
    for (const TrackStroke& stroke : strokes) {
      for (std::size_t at = 0; at < stroke.contacts.size(); at += 2) {
        TrackStroke part = stroke;
        const std::size_t end = std::min(at + 2, stroke.contacts.size());
        part.contacts.assign(stroke.contacts.begin() + std::ptrdiff_t(at),
                             stroke.contacts.begin() + std::ptrdiff_t(end));
        if (end < stroke.contacts.size()) {
          part.skipped.clear();
        }
        parted.tracks->Restore({part}, at > 0);
      }
    }
    ExpectSame(first, parted);
    for (int i = 0; i < 500; ++i) {
      const std::vector<TrackAddition> wheels = rover.Step(false);
      for (Ground* ground : {&first, &whole, &parted}) {
        ground->tracks->Add(wheels);
      }
    }
    ExpectSame(first, whole);
    ExpectSame(first, parted);
    if (seed == 1) {
      ExpectSamePosts(first, parted);
    }
  }
}

// A contact beside the line, by less than the tolerance, reaches into the next square until it is
// left out: whoever has the line alone must come to the same.
TEST(TrackRestore, WhatWasThereForAWhileLeavesNothing) {
  Ground first;
  const double y = 2.0 - Rut().Reach() - 3e-4;
  const auto roll = [&](double x, double aside) {
    first.tracks->Add({Stroke("wheel", Rut(), {{{x, y + aside}, 0.05, 0.0, x}})});
  };
  const Eigen::AlignedBox2d beyond(Eigen::Vector2d(0.1, 2.1), Eigen::Vector2d(0.2, 2.2));
  roll(0.1, 0.0);
  EXPECT_FALSE(first.tracks->Reaches(beyond));
  roll(0.2, 5e-4);
  EXPECT_TRUE(first.tracks->Reaches(beyond));
  roll(0.9, 0.0);
  EXPECT_FALSE(first.tracks->Reaches(beyond));
  EXPECT_EQ(first.tracks->Strokes()[0].skipped.size(), 1u);
  Ground second;
  second.tracks->Restore(first.tracks->Strokes());
  EXPECT_EQ(first.tracks->Statistics().bytes, second.tracks->Statistics().bytes);
}

TEST(TrackRestore, ATerrainThatIsFullHasRoomForItsOwn) {
  WheelTracksOptions options;
  options.byteBudget = 64 << 10;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Ground first(801, Hills, 124, options);
    std::mt19937 random(seed);
    const auto fill = [&](int steps) { // until not even so few fit
      for (int i = 0; i < 10000; ++i) {
        try {
          first.tracks->Add({Stroke("a", Rut(), Wander(random, steps, true))});
        } catch (const Error& error) {
          ASSERT_EQ(error.GetKind(), Error::Kind::Resource);
          return;
        }
      }
      FAIL() << "it is never full";
    };
    fill(20);
    fill(1);
    EXPECT_GT(first.tracks->Statistics().bytes, 60000u);
    Ground second(801, Hills, 124, options);
    second.tracks->Restore(first.tracks->Strokes());
    ExpectSame(first, second);
    if (seed == 1) {
      ExpectSamePosts(first, second);
    }
    EXPECT_THROW(second.tracks->Restore(first.tracks->Strokes()), Error); // twice is too much
    ExpectSame(first, second);
  }
}

TEST(TrackRestore, WhatIsNotAcceptedIsRejected) {
  WheelTracks tracks("ground");
  TrackStroke fine;
  fine.name = "fine";
  fine.contacts = {{{0.0, 0.0}, 0.1, 0.0, 0.0}};
  const auto rejected = [&](TrackStroke stroke, bool continues, const std::string& part) {
    const std::size_t before = tracks.StrokeCount();
    try {
      tracks.Restore(continues ? std::vector<TrackStroke>{stroke, fine}
                               : std::vector<TrackStroke>{fine, stroke},
                     continues);
      ADD_FAILURE() << part << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(tracks.StrokeCount(), before);
  };
  rejected(fine, true, "to go on");
  TrackStroke stroke = fine;
  stroke.contacts[0].rolled = TrackContact::Unknown;
  rejected(stroke, false, "rolled is nan");
  stroke = fine;
  stroke.contacts.clear();
  rejected(stroke, false, "no contact");
  stroke = fine;
  stroke.skipped.assign(65, fine.contacts[0]);
  rejected(stroke, false, "65");
  stroke = fine;
  stroke.skipped = {{{std::nan(""), 0.0}, 0.1, 0.0, 0.0}};
  rejected(stroke, false, "coordinate");
  tracks.Restore({fine});
  stroke = fine;
  stroke.name = "other";
  rejected(stroke, true, "to go on");
  stroke = fine;
  stroke.profile.width = 0.3;
  rejected(stroke, true, "to go on");
}

} // namespace
} // namespace dspace::testing
