// Words that programs write where a number is not finite.
#include <dspace/import/files/NumberWords.h>

#include <gtest/gtest.h>

using namespace dspace;

TEST(NumberWords, WordsThatAreNotFinite) {
  for (const char* word : {"nan", "NaN", "-nan", "+NAN", "-nan(ind)", "nan(0x1)", "inf", "-Inf",
                           "INFINITY", "1.#QNAN", "1.#INF", "-1.#IND", "1.#inf00"}) {
    EXPECT_TRUE(IsNotFiniteWord(word)) << word;
  }
  for (const char* word :
       {"", "-", "0", "1e5", "1.5", "infinite", "nano", "in", "na", "--inf", "1.", "1.0#INF"}) {
    EXPECT_FALSE(IsNotFiniteWord(word)) << word;
  }
}
