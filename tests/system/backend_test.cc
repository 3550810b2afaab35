// What draws: the ways to a GL context side by side, and drivers that hang or crash.
#include "server/picture/backend.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/system/errors.h"
#include "render/image/compare.h"
#include "render/image/png_file.h"
#include "server/picture/backend_probe.h"
#include "server/picture/child_process.h"
#include "tests/folders.h"
#include "tests/patience.h"
#include "tests/process.h"
#include "tests/render/test_scene.h"
#include "tests/server/http/test_client.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Kinescope;
using testing::kPatience;
using testing::ProgramResult;
using testing::RestOfLine;
using testing::RunProgram;
using testing::TempFolder;

ProgramResult Picture(const fs::path& out, const std::string& backend,
                      const std::vector<std::string>& environment = {}) {
  return Kinescope({"render", "demo:lift", "--time", "3", "--size", "160x90", "--backend", backend,
                    "--out", out.string()},
                   environment);
}

class Backend : public ::testing::Test {
 protected:
  // A program started so has a driver that hangs while hang_ exists.
  std::vector<std::string> HangingDriver() const {
    return {
        "LD_PRELOAD=" + kinescope::testing::InBuild("tests/system/libhanging_driver.so").string(),
        "HANGING_DRIVER_FILE=" + hang_.string()};
  }
  void Hang() const { std::ofstream(hang_).flush(); }

  TempFolder folder_, switches_;
  fs::path hang_ = switches_ / "hang";
};

TEST_F(Backend, RendersTheSameBytesWithEglAsWithOsmesa) {
  ASSERT_EQ(Picture(folder_ / "osmesa.png", "osmesa").exit_code, 0);
  const ProgramResult egl = Picture(folder_ / "egl.png", "egl");
  ASSERT_EQ(egl.exit_code, 0) << egl.err;
  EXPECT_EQ(render::ReadPng(folder_ / "egl.png").rgba,
            render::ReadPng(folder_ / "osmesa.png").rgba);
  // Other drivers have their rows from the bottom up; Mesa's without its extension does, too.
  ASSERT_EQ(Picture(folder_ / "turned.png", "egl", {"MESA_EXTENSION_OVERRIDE=-GL_MESA_pack_invert"})
                .exit_code,
            0);
  EXPECT_EQ(render::ReadPng(folder_ / "turned.png").rgba,
            render::ReadPng(folder_ / "osmesa.png").rgba);
}

TEST_F(Backend, RendersWithEglOnSeveralThreads) {
  const SceneState state = testing::MixedScene(testing::Posture::kStanding);
  render::PictureSpec spec;
  spec.width = 160;
  spec.height = 90;
  std::array<render::Image, 4> pictures;
  std::array<std::thread, 4> threads;
  for (std::size_t i = 0; i < threads.size(); ++i) {
    threads[i] = std::thread([&, i] {
      const auto renderer = render::MakeRenderer("egl");
      const render::Camera camera = render::NamedCamera("iso", state);
      for (int k = 0; k < 5; ++k) pictures[i] = renderer->Render(state, camera, spec);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const render::Image& picture : pictures) EXPECT_EQ(picture.rgba, pictures[0].rgba);
  EXPECT_GT(std::count(pictures[0].rgba.begin(), pictures[0].rgba.end(), 255), 160 * 90);
}

// As a service or a container has it: no DISPLAY, HOME, PATH or XDG folder.
TEST_F(Backend, RendersWithEglWithoutEnvironmentVariables) {
  const ProgramResult result =
      RunProgram({"/usr/bin/env", "-i", testing::KinescopePath(), "render", "demo:n_pose", "--size",
                  "64x64", "--backend", "egl", "--out", folder_ / "a.png"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

TEST_F(Backend, RendersTheSameBytesInEightProcesses) {
  ASSERT_EQ(Picture(folder_ / "alone.png", "osmesa").exit_code, 0);
  const std::string command = fmt::format(
      "for i in 1 2 3 4 5 6 7 8; do '{}' render demo:lift --time 3 --size 160x90 --out "
      "'{}'/$i.png >/dev/null & done; wait",
      testing::KinescopePath(), folder_.path().string());
  ASSERT_EQ(RunProgram({"/bin/bash", "-c", command}).exit_code, 0);
  const render::Image alone = render::ReadPng(folder_ / "alone.png");
  for (int i = 1; i <= 8; ++i) {
    EXPECT_EQ(render::ReadPng(folder_ / (std::to_string(i) + ".png")).rgba, alone.rgba) << i;
  }
}

TEST_F(Backend, RejectsAnUnknownOrMissingBackEndWithARemedy) {
  const ProgramResult unknown = Picture(folder_ / "a.png", "vulkan");
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, AllOf(HasSubstr("vulkan"), HasSubstr("osmesa"), HasSubstr("auto")));
  // Without any vendor's library EGL has nothing to offer.
  const ProgramResult missing =
      Picture(folder_ / "a.png", "egl", {"__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere.json"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, AllOf(HasSubstr("libegl-mesa0"), HasSubstr("--backend=osmesa")));
  const ProgramResult no_gpu =
      Picture(folder_ / "a.png", "egl_device",
              {"__EGL_VENDOR_LIBRARY_FILENAMES=/usr/share/glvnd/egl_vendor.d/50_mesa.json",
               "LIBGL_ALWAYS_SOFTWARE=1"});
  if (app::FindGpus().empty()) {
    EXPECT_EQ(no_gpu.exit_code, 2);
    EXPECT_THAT(no_gpu.err, AllOf(HasSubstr("GPU"), HasSubstr("--backend=osmesa")));
  }
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(Backend, FallsBackWithTheReasonIfTheGpuDoesNotWork) {
  fs::create_directories(folder_ / "dri");
  for (const char* name : {"dri/card0", "dri/renderD128", "dri/renderD", "nvidia0", "nvidiactl"}) {
    std::ofstream(folder_ / name).flush();
  }
  EXPECT_THAT(app::FindGpus(folder_.path()),
              ::testing::ElementsAre(HasSubstr("dri/renderD128"), HasSubstr("nvidia0")));
  app::BackendOptions options;
  const app::Machine machine{folder_.path(), testing::KinescopePath()};
  EXPECT_THAT(
      app::ChooseBackend(options, machine).note,
      AllOf(HasSubstr("a GPU is present"), HasSubstr("renderD128"), HasSubstr("egl_device")));
  const app::Machine without_gpu{switches_.path(), testing::KinescopePath()};
  EXPECT_EQ(app::ChooseBackend(options, without_gpu).note, "");
  options.backend = std::string("auto");
  EXPECT_EQ(app::ChooseBackend(options, without_gpu).name, "osmesa");
  if (!app::FindGpus().empty()) return;  // the pretended GPU would be a real one
  const app::BackendChoice choice = app::ChooseBackend(options, machine);
  EXPECT_EQ(choice.name, "osmesa");
  EXPECT_THAT(choice.note,
              AllOf(HasSubstr("rendered by osmesa"), HasSubstr("egl_device does not")));
}

TEST_F(Backend, MeasuresEachBackEndAndSurvivesDriversThatHangOrCrash) {
  const ProgramResult fine = Kinescope({"probe", "--json"});
  ASSERT_EQ(fine.exit_code, 0) << fine.err;
  const auto found = nlohmann::json::parse(fine.out);
  for (const char* name : {"osmesa", "egl"}) {
    const auto& backend = found.at("backends").at(name);
    EXPECT_TRUE(backend.at("works").get<bool>()) << backend.dump();
    EXPECT_THAT(backend.at("renderer").get<std::string>(), HasSubstr("llvmpipe"));
    EXPECT_TRUE(backend.at("software").get<bool>());
    EXPECT_GT(backend.at("pictures_per_second").get<double>(), 0);
    EXPECT_GT(backend.at("first_picture_seconds").get<double>(), 0);
  }
  EXPECT_EQ(found.at("hardware").at("devices").size(), app::FindGpus().size());

  std::ofstream(hang_) << "crash\n";
  auto environment = HangingDriver();
  environment.insert(environment.end(), {"TMPDIR=/nowhere", "ROS_MASTER_URI=nowhere"});
  const ProgramResult crash = Kinescope({"probe", "--json"}, environment);
  EXPECT_EQ(crash.exit_code, 1) << "nothing draws";
  const auto problems = nlohmann::json::parse(crash.out);
  EXPECT_THAT(problems.at("backends").at("osmesa").at("reason"), HasSubstr("crashed"));
  EXPECT_THAT(problems.at("encoders").at("h264").at("reason"),
              HasSubstr("TMPDIR=/nowhere: is not a folder"));
  EXPECT_THAT(problems.at("ros").at("reason"), HasSubstr("ROS_MASTER_URI=nowhere: expected http"));
  std::ofstream(hang_).flush();
  const ProgramResult hang = Kinescope({"probe", "--json", "--limit_secs", "1"}, HangingDriver());
  EXPECT_EQ(hang.exit_code, 1);
  EXPECT_THAT(nlohmann::json::parse(hang.out).at("backends").at("osmesa").at("reason"),
              HasSubstr("hangs"));
}

TEST_F(Backend, EndsACommandWithoutFileIfTheDriverDoesNotRespond) {
  Hang();
  for (const char* name : {"a.png", "a.mp4"}) {
    const ProgramResult result = Kinescope({"render", "demo:lift", "--size", "64x64",
                                            "--draw_limit_secs", "0.3", "--out", folder_ / name},
                                           HangingDriver());
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, AllOf(HasSubstr("a picture of 64 x 64"), HasSubstr("does not respond"),
                                  HasSubstr("--draw_limit_secs")));
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
  }
  EXPECT_THAT(folder_.Names(), IsEmpty());
}

TEST_F(Backend, ReportsADriverThatDoesNotRespondAndContinuesAfterwards) {
  const std::string command = fmt::format(
      "{}; exec '{}' serve --source demo:n_pose --http_port 0 --ros off --picture_size 64x64 "
      "--draw_limit_secs 5 2>&1; ",  // the first picture compiles shaders, on a busy machine too
      fmt::format("export {}", fmt::join(HangingDriver(), " ")), testing::KinescopePath());
  testing::Process server({"/bin/bash", "-c", command});
  const std::string page = RestOfLine(server, "page at ");
  const int port = std::stoi(page.substr(page.rfind(':') + 1));
  const auto pictures = [&] {
    return http::testing::Fetch(port, "/api/v1/diagnostics").json().at("pictures");
  };
  const char* snapshot = "/api/v1/snapshot.png?width=64&height=64";
  ASSERT_EQ(http::testing::Fetch(port, snapshot).status, 200);
  EXPECT_FALSE(pictures().at("driver_hung").get<bool>());
  Hang();
  const http::testing::Response hung = http::testing::Fetch(port, snapshot);
  EXPECT_EQ(hung.status, 503);
  EXPECT_THAT(hung.body, HasSubstr("does not respond"));
  EXPECT_TRUE(pictures().at("driver_hung").get<bool>());
  EXPECT_THAT(pictures().at("last_error"), HasSubstr("does not respond"));
  EXPECT_EQ(http::testing::Fetch(port, snapshot).status, 503) << "and at once";
  fs::remove(hang_);
  RestOfLine(server, "the graphics driver responds again");
  EXPECT_FALSE(pictures().at("driver_hung").get<bool>());
  EXPECT_EQ(http::testing::Fetch(port, snapshot).status, 200);
  Hang();
  EXPECT_EQ(http::testing::Fetch(port, snapshot).status, 503);
  server.Signal(SIGINT);  // the drawing thread cannot be joined, and the program ends all the same
  EXPECT_THAT(RestOfLine(server, "kinescope: stopped without a clean shutdown: "),
              HasSubstr("does not respond"));
}

TEST(ChildProcess, ReportsHowItEnded) {
  using app::RunChild;
  const auto shell = [](const std::string& script, int millis = 20'000) {
    return RunChild({"/bin/sh", "-c", script}, std::chrono::milliseconds(millis));
  };
  const app::ChildResult spoke = shell("echo out; echo err >&2; exit 3");
  EXPECT_EQ(spoke.exit_code, 3);
  EXPECT_EQ(spoke.out, "out\n");
  EXPECT_EQ(spoke.err, "err\n");
  EXPECT_EQ(shell("kill -SEGV $$").signal, SIGSEGV);
  EXPECT_TRUE(shell("exec sleep 100", 50).was_too_slow);
  EXPECT_EQ(shell("head -c 3000000 /dev/zero; echo done >&2").err, "done\n");
  EXPECT_THROW((void)RunChild({"/nowhere/program"}, kPatience), std::runtime_error);
}

}  // namespace
}  // namespace kinescope
