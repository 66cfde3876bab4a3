#include <dspace/scene/NumberedNames.h>

#include <random>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

using dspace::NumberedNames;

// The names that are taken, and the rule word by word: the first of "box", "box 2", "box 3", ...
struct Names {
  std::set<std::string> taken;
  NumberedNames numbered;

  std::string Rule(const std::string& wanted) const {
    std::string name = wanted;
    for (int n = 2; this->taken.count(name); ++n) {
      name = wanted + " " + std::to_string(n);
    }
    return name;
  }
  std::string First(const std::string& wanted) {
    return this->numbered.First(wanted, [this](const auto& name) { return this->Has(name); });
  }
  bool Has(const std::string& name) {
    ++this->asked;
    return this->taken.count(name) != 0;
  }
  void Free(const std::string& name) {
    this->taken.erase(name);
    this->numbered.Freed(name);
  }
  std::size_t asked = 0;
};

TEST(NumberedNames, CountsFromTwo) {
  Names names;
  for (const char* expected : {"box", "box 2", "box 3", "box 4"}) {
    EXPECT_EQ(names.First("box"), expected);
    EXPECT_EQ(names.First("box"), expected); // it is free until it is taken
    names.taken.insert(expected);
  }
  EXPECT_EQ(names.First("ball"), "ball");
}

TEST(NumberedNames, TakesTheLowestThatIsFree) {
  Names names;
  names.taken = {"box", "box 2", "box 3", "box 5"};
  EXPECT_EQ(names.First("box"), "box 4");
  names.taken.insert("box 4");
  EXPECT_EQ(names.First("box"), "box 6");
  names.Free("box 3");
  names.Free("box 2");
  EXPECT_EQ(names.First("box"), "box 2");
  names.taken.insert("box 2"); // somebody's own name
  EXPECT_EQ(names.First("box"), "box 3");
  names.Free("box");
  EXPECT_EQ(names.First("box"), "box");
}

TEST(NumberedNames, NamesThatEndOtherwiseAreNoNumbers) {
  Names names;
  names.taken = {"box", "box 2", "box 3"};
  EXPECT_EQ(names.First("box"), "box 4");
  for (const char* other : {"box 02", "box 1", "box 0", "box -2", "box +2", "box 2x", "box ", "box",
                            "2", " 2", "", "box 99999999999999999999999", "box  2"}) {
    names.numbered.Freed(other);
    EXPECT_EQ(names.First("box"), "box 4") << other;
  }
}

// Also where wanted names end in numbers themselves, and where names are given.
TEST(NumberedNames, FollowTheRuleWhateverIsTakenAndFreed) {
  const std::vector<std::string> wanted = {"box", "box 2", "a b", "box 2 2", "x/y"};
  std::mt19937 random(1);
  const auto below = [&](std::size_t n) { return std::size_t(random() % n); };
  Names names;
  for (int i = 0; i < 20000; ++i) {
    const std::string& one = wanted[below(wanted.size())];
    const unsigned way = unsigned(below(10));
    if (way < 5) {
      const std::string expected = names.Rule(one);
      ASSERT_EQ(names.First(one), expected) << i;
      names.taken.insert(expected);
    } else if (way < 9 && !names.taken.empty()) {
      auto gone = names.taken.begin();
      std::advance(gone, std::ptrdiff_t(below(names.taken.size())));
      names.Free(std::string(*gone));
    } else {
      names.taken.insert(one + " " + std::to_string(below(60)));
    }
  }
  EXPECT_GT(names.taken.size(), 50u);
}

// Counted, not timed: how often it asks for a name.
TEST(NumberedNames, AskInProportionToTheNames) {
  Names names;
  constexpr std::size_t Count = 20000;
  for (std::size_t i = 0; i < Count; ++i) {
    names.taken.insert(names.First("box"));
  }
  EXPECT_LT(names.asked, 4 * Count);
  names.asked = 0;
  for (std::size_t i = 0; i < Count; ++i) { // the lowest goes, two come
    names.Free("box 2");
    names.taken.insert(names.First("box"));
    names.taken.insert(names.First("box"));
  }
  EXPECT_LT(names.asked, 8 * Count);
  EXPECT_EQ(names.taken.size(), 2 * Count);
}

} // namespace
