#include "server/loads/load_classifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace kinescope::loads {
namespace {

constexpr std::int64_t kMillis = 1'000'000;

char Letter(LoadClass load_class) { return "?GOR"[static_cast<int>(load_class)]; }

TEST(LoadClassifier, FollowsTheReferenceSequenceWithoutFilterAndDwell) {
  LoadClassifier::Settings settings;
  settings.low_pass_secs = settings.dwell_up_secs = settings.dwell_down_secs = 0;
  LoadClassifier classifier(settings);
  std::string classes;
  std::int64_t now = 0;
  for (const double ratio : {.10, .29, .31, .27, .24, .61, .58, .54, .20, .70, .50, .20}) {
    classes += Letter(classifier.Update(ratio, now += 10 * kMillis));
  }
  EXPECT_EQ(classes, "GGOOGRROGROG");  // joint-loads.md 4.3
}

// Seconds until the class leaves `from` when the ratio jumps to `to`, at 100 samples a second.
double SecsToLeave(double from, double to) {
  LoadClassifier classifier;
  std::int64_t now = 0;
  const LoadClass start = classifier.Update(from, now);
  for (int i = 1; i <= 1000; ++i) {
    if (classifier.Update(to, now += 10 * kMillis) != start) return 0.01 * i;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(LoadClassifier, ChangesTheClassAfterFilterAndDwellTime) {
  // The filter passes 0.30 after -0.15 ln(0.6) = 0.077 s on the way from 0 to 0.75; then 0.2 s.
  EXPECT_NEAR(SecsToLeave(0.0, 0.75), 0.077 + 0.2, 0.02);
  // Down from 0.50 to 0: below 0.25 after 0.15 ln 2 = 0.104 s; then 0.5 s.
  EXPECT_NEAR(SecsToLeave(0.50, 0.0), 0.104 + 0.5, 0.02);
  EXPECT_TRUE(std::isinf(SecsToLeave(0.50, 0.27)));  // inside the hysteresis: stays for ever
}

TEST(LoadClassifier, SkipsAClassInOneUpdateAfterTheDwellTime) {
  LoadClassifier::Settings settings;
  settings.low_pass_secs = 0;
  LoadClassifier classifier(settings);
  std::int64_t now = 0;
  std::string classes(1, Letter(classifier.Update(0.1, now)));
  for (int i = 0; i < 22; ++i) classes += Letter(classifier.Update(0.9, now += 10 * kMillis));
  EXPECT_EQ(classes, "G" + std::string(20, 'G') + "RR");
}

TEST(LoadClassifier, ReportsMissingDataAsUnknownAndRestartsAfterwards) {
  LoadClassifier classifier;
  EXPECT_EQ(classifier.Update(0.1, 0), LoadClass::kLow);
  EXPECT_EQ(classifier.Update(std::nan(""), 10 * kMillis), LoadClass::kUnknown);
  EXPECT_EQ(classifier.Update(0.9, 20 * kMillis), LoadClass::kHigh);
}

TEST(LoadClassifier, RestartsAfterAGapOrABackwardTimeStep) {
  LoadClassifier classifier;
  EXPECT_EQ(classifier.Update(0.9, 0), LoadClass::kHigh);
  EXPECT_EQ(classifier.Update(0.1, 600 * kMillis), LoadClass::kLow);
  EXPECT_EQ(classifier.Update(0.9, 100 * kMillis), LoadClass::kHigh);
}

}  // namespace
}  // namespace kinescope::loads
