#include "server/scene/model_memory.h"

#include <gtest/gtest.h>

#include <memory>

#include "server/scene/model_factory.h"

namespace kinescope::app {
namespace {

std::shared_ptr<const PersonModel> Made(double height_m) {
  ModelSettings settings;
  settings.height_m = height_m;
  return ModelFactory(settings).Make({}, 1);
}

TEST(ModelMemory, SharesEqualModelsWhileSomebodyHasThem) {
  auto first = Made(1.8);
  EXPECT_EQ(Made(1.8), first);
  EXPECT_NE(Made(1.81), first);
  const std::weak_ptr<const PersonModel> gone = first;
  first.reset();
  EXPECT_TRUE(gone.expired());
}

TEST(ModelMemory, TellsModelsApartThatMakeTheSameUrdf) {
  ModelSettings settings;
  const auto assumed = ModelFactory(settings).Make({}, 1);
  EXPECT_NE(ModelFactory(settings).Make({}, 2), assumed);  // sinks reload by the revision
  settings.body.mass_is_assumed = false;
  EXPECT_NE(ModelFactory(settings).Make({}, 1), assumed);
}

}  // namespace
}  // namespace kinescope::app
