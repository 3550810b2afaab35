#include "server/options/ros_names.h"

#include <gmock/gmock.h>

namespace kinescope::app {
namespace {

using ::testing::ElementsAre;

TEST(ShownTopics, HaveGrids) {
  ShownTopicsValue value;
  value.Parse("grid:,grid:table(size=0.5,cells=20,layers=2,plane=yz,at=1|-2|0.5,missing=scene)");
  ASSERT_EQ(value->size(), 2u);
  EXPECT_TRUE((*value)[0].is_grid && (*value)[0].is_frame);
  EXPECT_EQ((*value)[0].style.grid.cells, 10);
  const ShownTopic& second = (*value)[1];
  EXPECT_EQ(second.name, "table");
  EXPECT_EQ(second.style.size_m, 0.5);
  EXPECT_EQ(second.style.grid.cells, 20);
  EXPECT_EQ(second.style.grid.layers, 2);
  EXPECT_EQ(second.style.grid.plane, GridStyle::Plane::kYz);
  EXPECT_THAT(second.style.grid.offset, ElementsAre(1, -2, 0.5));
  EXPECT_TRUE(second.style.stands_in_scene && !second.style.is_told_missing);
  for (const char* wrong :
       {"grid:*", "grid:a b", "grid:(cells=0)", "grid:(cells=1001)", "grid:(cells=2.5)",
        "grid:(layers=21)", "grid:(cells=200,layers=1)", "grid:(plane=zx)", "grid:(at=1|2)",
        "grid:(at=1|2|3|4)", "grid:(at=1|2|x)", "grid:(at=1e9|0|0)", "grid:(missing=world)"}) {
    EXPECT_THROW(ShownTopicsValue().Parse(wrong), options::BadValue) << wrong;
  }
}

TEST(ShownTopics, RefuseStylesThatSayNothing) {
  for (const char* bad : {"/a(",
                          "/a()b",
                          "/a(color=red)",
                          "/a(size=0)",
                          "/a(size=11)",
                          "/a(pixels=0.5)",
                          "/a(pixels=101)",
                          "/a(pixels=few)",
                          "/a(alpha=2)",
                          "/a(shape=cube)",
                          "/a(scheme=rgb)",
                          "/a(updates=yes)",
                          "/a(points=0)",
                          "/a(keep=0)",
                          "/a(keep=1001)",
                          "/a(keep=2.5)",
                          "/a(decay=-1)",
                          "/a(decay=601)",
                          "/a(step=far)",
                          "/a(points=100001)",
                          "/a(points=1.5)",
                          "/a(by=)",
                          "/a(by=a/b)",
                          "/a(from=low)",
                          "/a(to=1e13)",
                          "/a(low=blue)",
                          "/a(force=-1)",
                          "/a(force=2000)",
                          "/a(width=0)",
                          "tf:/odom",
                          "/a(covariance=-1)",
                          "/a(covariance_alpha=2)",
                          "/a(covariance_color=red)",
                          "/a(without=)",
                          "/a(without=a||b)",
                          "/a(turn_covariance=-1)",
                          "/a(turn_covariance_alpha=2)",
                          "/a(turn_covariance_color=red)",
                          "/a(turn_covariance_offset=0)",
                          "/a(turn_covariances=1)",
                          "/a(pose_size=0)",
                          "/a(pose_color=red)",
                          "/a(handles=no)",
                          "/a(linear=far)",
                          "tf:**",
                          "tf:*(names=no)",
                          "tf:*(timeout=0)",
                          "tf:*(without=a b)",
                          "tf:*(without=)",
                          "tf:a b",
                          "/a(torque_color=5)",
                          "/a(small=no)",
                          "/a(rainbow=no)",
                          "/a(height=1)",
                          "/a(color)",
                          "(size=1)",
                          "/a b"}) {
    ShownTopicsValue value;
    EXPECT_THROW(value.Parse(bad), options::BadValue) << bad;
  }
}

}  // namespace
}  // namespace kinescope::app
