#include "server/scene/new_samples.h"

#include <gtest/gtest.h>

#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

PersonState PersonWith(int character, std::int64_t stamp_nanos, std::uint32_t counter) {
  PersonState person;
  person.character = character;
  person.sample.stamp_nanos = stamp_nanos;
  person.sample.counter = counter;
  return person;
}

TEST(NewSamples, TakesEachSampleOfEachPersonOnce) {
  NewSamples fresh;
  EXPECT_TRUE(fresh.IsNew(PersonWith(0, 10, 1)));
  EXPECT_FALSE(fresh.IsNew(PersonWith(0, 10, 1)));
  EXPECT_TRUE(fresh.IsNew(PersonWith(1, 10, 1)));
  EXPECT_FALSE(fresh.IsNew(PersonWith(0, 10, 1)));
  EXPECT_TRUE(fresh.IsNew(PersonWith(0, 20, 2)));
  EXPECT_TRUE(fresh.IsNew(PersonWith(1, 20, 1))) << "the counter has started over";
}

TEST(SceneReader, IncludesTheSampleAtTheEndOfALengthWhateverTheRounding) {
  EXPECT_TRUE(IsWithinLength(5, 1'000'000'005 + 300, 1.0));
  EXPECT_FALSE(IsWithinLength(5, 1'000'000'005 + 3000, 1.0));
  EXPECT_TRUE(IsWithinLength(5, 9'000'000'000, std::nullopt));
}

}  // namespace
}  // namespace kinescope::app
