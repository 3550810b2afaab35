// What of another build is not loaded: tables that begin with other sizes.
#include "render/module.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace kinescope::render {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr char kPlotFile[] = "libkinescope_plot.so";

struct TableOfOneType {
  ModuleAbi<Plot> abi;
};
struct TableWithAnotherImage {
  struct LargerImage : Image {
    double depth[2] = {};  // more than the padding at its end
  };
  ModuleAbi<Plot, PlotPanel, PlotBand, PlotGap, PlotLimit, PlotCurve, PlotClassInterval, PlotMark,
            PlotSwatch, PlotText, LargerImage, Ink, Tile, Font, Glyph>
      abi;
};

template <class Table>
std::string ErrorOfLoading(const char* entry = kPlotEntry) {
  try {
    OpenModule<Table>(kPlotFile, entry);
  } catch (const RenderError& error) {
    return error.what();
  }
  return "";
}

TEST(Module, IsLoadedIfItBelongsToThisBuild) {
  EXPECT_EQ(ErrorOfLoading<PlotModule>(), "");
  EXPECT_NE(OpenModule<PlotModule>(kPlotFile, kPlotEntry).svg, nullptr);
}

TEST(Module, IsRejectedWithARemedyIfItBelongsToAnotherBuild) {
  EXPECT_THAT(ErrorOfLoading<TableWithAnotherImage>(),
              AllOf(HasSubstr(kPlotFile), HasSubstr("different builds"), HasSubstr("again")));
  EXPECT_THAT(ErrorOfLoading<TableOfOneType>(), HasSubstr("different builds"));
  EXPECT_THAT(ErrorOfLoading<PlotModule>("NoSuchEntry"), HasSubstr("NoSuchEntry"));
}

}  // namespace
}  // namespace kinescope::render
