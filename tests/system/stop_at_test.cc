// `serve --stop_at`: a recording that is read at once and stands still at a moment.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/process.h"
#include "tests/server/http/test_client.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

using http::testing::Fetch;
using nlohmann::json;
using testing::ExpectRefusal;
using testing::Kinescope;
using testing::RestOfLine;

// Of a server that has stopped.
class StoppedServer {
 public:
  explicit StoppedServer(const std::string& time)
      : process_({"/bin/sh", "-c",
                  fmt::format("exec '{}' serve demo:lift --stop_at {} --http_port 0 --pictures off "
                              "--marks_file '{}' 2>&1",
                              testing::KinescopePath(), time, (folder_ / "marks").string())}) {
    port_ = std::stoi(RestOfLine(process_, "page at http://127.0.0.1:"));
    stopped_ = RestOfLine(process_, "stopped at ");
  }

  const std::string& stopped() const { return stopped_; }  // "2.000 s, sample 240"
  json Get(const std::string& route) const { return Fetch(port_, "/api/v1/" + route).json(); }

 private:
  testing::TempFolder folder_;
  testing::Process process_;
  int port_ = 0;
  std::string stopped_;
};

TEST(StopAt, StopsAtTheMomentWithEverySampleBeforeIt) {
  const StoppedServer server("60");
  EXPECT_EQ(server.stopped(), "60.000 s, sample 7200");
  const json diagnostics = server.Get("diagnostics");
  EXPECT_EQ(diagnostics.at("history").at("left_out"), 0);
  EXPECT_EQ(diagnostics.at("history").at("states"), 7202) << "7201 samples, and that of no data";
  EXPECT_EQ(diagnostics.at("source").at("skipped"), 0) << "they wait for nothing";
}

TEST(StopAt, IsTheSameInEachRun) {
  const auto all_of = [] {
    const StoppedServer server("3.5");
    json state = server.Get("state");
    EXPECT_LT(state.at("age_ms").get<double>(), 60'000) << "it came now";
    EXPECT_EQ(state.at("liveness"), "live") << "time stands still";
    state.erase("age_ms");
    return json{state, server.Get("series?person=0&keys=l5_s1,rate,margin&from=3600000000&to="
                                  "3604000000&columns=40")};
  };
  const json one = all_of();
  EXPECT_EQ(one, all_of());
  EXPECT_EQ(one.at(1).at("samples").at(35), 1) << one.at(1).dump();
}

TEST(StopAt, AfterTheEndOfARecordingIsRefused) {
  const testing::TempFolder folder;
  const std::string file = folder / "walk.mvnx";
  ASSERT_EQ(Kinescope({"convert", "demo:walk", "--seconds", "1", "--out", file}).exit_code, 0);
  const auto result =
      Kinescope({"serve", file, "--stop_at", "5", "--http_port", "0", "--pictures", "off"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err,
              ::testing::HasSubstr("ends 1.000 s after its first sample, before 5.000 s; "
                                   "choose an earlier time"));
}

TEST(StopAt, HasNoUseForLoopsAndRos) {
  ExpectRefusal(Kinescope({"serve", "demo:lift", "--stop_at", "5", "--loop"}), "--loop");
  ExpectRefusal(Kinescope({"serve", "demo:lift", "--stop_at", "5", "--ros", "required"}), "--ros");
  ExpectRefusal(Kinescope({"serve", "udp://:0", "--stop_at", "5"}), "--stop_at=5: a live source");
}

}  // namespace
}  // namespace kinescope
