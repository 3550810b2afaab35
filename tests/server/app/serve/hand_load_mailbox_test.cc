#include "server/app/serve/hand_load_mailbox.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinescope::app {
namespace {

HandLoad RightHand(double mass_kg) {
  HandLoad load;
  load.is_known = true;
  load.mass_kg[urdf::kRight] = mass_kg;
  return load;
}

TEST(HandLoadMailbox, DeliversTheLatestLoadOfEachPersonOnce) {
  HandLoadMailbox mailbox;
  EXPECT_EQ(mailbox.Put(0, RightHand(1)), "");
  EXPECT_EQ(mailbox.Put(4, RightHand(2)), "");
  EXPECT_EQ(mailbox.Put(0, RightHand(3)), "");
  const auto loads = mailbox.TakeAll();
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads.at(0).mass_kg[urdf::kRight], 3);
  EXPECT_EQ(loads.at(4).mass_kg[urdf::kRight], 2);
  EXPECT_TRUE(mailbox.TakeAll().empty());
}

TEST(HandLoadMailbox, RejectsImpossibleLoads) {
  HandLoadMailbox mailbox;
  for (const double wrong : {500.0, -1.0, std::nan("")}) {
    EXPECT_NE(mailbox.Put(0, RightHand(wrong)), "") << wrong;
  }
  EXPECT_TRUE(mailbox.TakeAll().empty());
}

}  // namespace
}  // namespace kinescope::app
