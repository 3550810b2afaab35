/// RViz on a screen of its own, whose picture a test can read.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/system/ros/ros_fixture.h"
#include "tests/system/run_program.h"

namespace kinescope::testing {

class RVizProgram : public RosProgram {
 protected:
  static constexpr int kWidth = 800, kHeight = 600;
  using Pixels = std::vector<std::array<int, 3>>;  // rows from above

  void SetUp() override {
    RosProgram::SetUp();
    if (IsSkipped() || HasFatalFailure()) return;
    screen_ = std::make_unique<Process>(
        std::vector<std::string>{KINESCOPE_XVFB, "-displayfd", "1", "-noreset", "-screen", "0",
                                 fmt::format("{}x{}x24", kWidth, kHeight)});
    const auto display = screen_->ReadLine(kPatience);
    ASSERT_TRUE(display) << "Xvfb does not start";
    setenv("DISPLAY", (":" + *display).c_str(), 1);
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    setenv("HOME", folder_.path().c_str(), 1);
    setenv("ROS_PACKAGE_PATH", folder_.path().c_str(), 1);
  }

  void Write(const std::string& path, const std::string& bytes) const {
    std::filesystem::create_directories((folder_ / path).parent_path());
    std::ofstream(folder_ / path, std::ios::binary) << bytes;
  }

  /// With the configuration in view.rviz; its log is in rviz.log.
  std::unique_ptr<Process> StartRViz(const std::string& window = "--fullscreen") const {
    return std::make_unique<Process>(std::vector<std::string>{
        "/bin/bash", "-c",
        fmt::format("exec '{}' -d '{}' {} --splash-screen '' __name:=rviz >'{}' 2>&1",
                    KINESCOPE_RVIZ, (folder_ / "view.rviz").string(), window,
                    (folder_ / "rviz.log").string())});
  }

  /// What is on the screen; empty if it cannot be read.
  static Pixels Grab() {
    const std::string bytes =
        RunProgram({KINESCOPE_IMPORT, "-window", "root", "-depth", "8", "rgb:-"}).out;
    Pixels pixels(kWidth * kHeight);
    if (bytes.size() != 3 * pixels.size()) return {};
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        pixels[i][k] = static_cast<std::uint8_t>(bytes[3 * i + k]);
      }
    }
    return pixels;
  }

 private:
  std::unique_ptr<Process> screen_;
};

}  // namespace kinescope::testing
