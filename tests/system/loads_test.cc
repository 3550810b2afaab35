// `kinescope loads` as a biomechanist uses it: recordings in, tables, figures and a report out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "render/image/png_file.h"
#include "server/loads/joint_score.h"
#include "tests/csv_table.h"
#include "tests/folders.h"
#include "tests/process.h"
#include "tests/server/app/loads/trial_scenes.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using testing::CsvTable;
using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;
using testing::ReadFile;
using testing::SharedData;
using testing::TempFolder;

ProgramResult Loads(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "loads");
  return Kinescope(arguments);
}

// The program prints seven digits.
void ExpectSame(double printed, double value, const std::string& what) {
  if (std::isnan(value)) {
    EXPECT_TRUE(std::isnan(printed)) << what;
  } else {
    EXPECT_NEAR(printed, value, 1e-6 * std::max(1.0, std::abs(value))) << what;
  }
}

TEST(LoadsCommand, WritesTheLoadsThatTheLibraryComputesInEveryRow) {
  const TempFolder folder;
  const std::string csv = folder / "loads.csv";
  const ProgramResult result = Loads(
      {"demo:lift", "--seconds", "1", "--mass", "80", "--hand_load", "right:5", "--csv", csv});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  app::SceneOptions options;
  options.body.mass_kg = 80;
  options.loads.hands = loads::ParseHandLoad("right:5");
  // What the library says of the same recording.
  const testing::Scenes states = testing::ReadScenes("demo:lift", 1, options);
  const CsvTable table(ReadFile(csv));
  ASSERT_EQ(table.rows.size(), states.size());
  for (std::size_t row = 0; row < states.size(); ++row) {
    const PersonState& person = states[row]->people.at(0);
    for (const JointLoad& load : person.loads) {
      const std::string name(urdf::kJoints[urdf::At(load.joint)].ros_name);
      ExpectSame(table.Number(row, name + "_ratio"), load.ratio, name);
      ExpectSame(table.Number(row, name + "_capacity_Nm"), load.capacity, name);
      EXPECT_EQ(table.At(row, name + "_class"), Name(load.load_class));
      EXPECT_EQ(table.At(row, name + "_channel"), load.channel);
      const Eigen::Vector3d in_parent =
          person.links[urdf::At(urdf::ParentOf(load.joint))].orientation.conjugate() * load.moment;
      ExpectSame(table.Number(row, name + "_moment_x_Nm"), in_parent.x(), name);
      ExpectSame(table.Number(row, name + "_moment_z_Nm"), in_parent.z(), name);
    }
    ExpectSame(table.Number(row, "com_z_m"), person.forces.com_of_model.z(), "com");
    ExpectSame(table.Number(row, "cop_x_m"), person.cop->x(), "cop");
    ExpectSame(table.Number(row, "ground_force_z_N"), person.forces.ground_force.z(), "ground");
    ExpectSame(table.Number(row, "l5_s1_compression_N"), person.forces.lumbar->compression, "L5");
    ExpectSame(table.Number(row, "right_hand_load_kg"), 5, "hand");
  }
  EXPECT_EQ(table.At(0, "utc"), "") << "the built-in subject knows no time of day";
  EXPECT_NEAR(table.Number(states.size() - 1, "time_s"), 1, 1e-6);
}

TEST(LoadsCommand, WritesOneRowPerJointOnRequest) {
  const ProgramResult wide = Loads({"demo:lift", "--seconds", "0.1", "--csv", "-"});
  const ProgramResult tall =
      Loads({"demo:lift", "--seconds", "0.1", "--csv", "-", "--layout", "long"});
  const CsvTable wide_table(wide.out), tall_table(tall.out);
  ASSERT_GT(wide_table.rows.size(), 10U);
  ASSERT_EQ(tall_table.rows.size(), 15 * wide_table.rows.size());
  for (std::size_t i = 0; i < tall_table.rows.size(); ++i) {
    const std::string joint = tall_table.At(i, "joint");
    EXPECT_EQ(tall_table.At(i, "ratio"), wide_table.At(i / 15, joint + "_ratio"));
    EXPECT_EQ(tall_table.At(i, "time_s"), wide_table.At(i / 15, "time_s"));
  }
}

TEST(LoadsCommand, WritesExposureAndAssumptionsAsJson) {
  const ProgramResult result =
      Loads({"demo:lift", "--seconds", "2", "--sex", "female", "--json", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["options"]["sex"], "female");
  EXPECT_EQ(json["options"]["mass"], nullptr);
  EXPECT_EQ(json["samples"].size(), 241U);  // 120 Hz
  EXPECT_EQ(json["samples"][0].size(), json["columns"].size());
  const auto& person = json["people"].at(0);
  EXPECT_EQ(person["mass_kg"], 62);
  std::map<std::string, bool> assumed;
  for (const auto& fact : person["facts"]) assumed[fact["name"]] = fact["is_assumed"];
  EXPECT_TRUE(assumed.at("mass"));
  EXPECT_TRUE(assumed.at("hand load"));
  EXPECT_FALSE(assumed.at("sex"));
  ASSERT_EQ(person["exposure"].size(), 15U);
  for (const auto& joint : person["exposure"]) {
    double sum = 0;
    for (const auto& [name, secs] : joint["seconds"].items()) sum += secs.get<double>();
    EXPECT_NEAR(sum, 241 / 120.0, 1e-5) << joint["joint"];
  }
}

// Exposure is what anybody counts in the samples that stand beside it.
TEST(LoadsCommand, ReportsTheExposureThatItsSamplesHave) {
  std::vector<std::vector<std::string>> trials = {
      {"demo:walk", "--seconds", "8"},
      {"demo:lift", "--seconds", "8", "--hand_load", "both:10"},
      {"demo:lift", "--seconds", "4", "--class_limits", "0.1,0.2", "--shown", "momentary"}};
  const std::string recording = SharedData("mvnx/test_mocap.mvnx");
  if (fs::exists(recording)) trials.push_back({recording});
  for (std::vector<std::string> arguments : trials) {
    arguments.insert(arguments.end(), {"--json", "-"});
    const auto json = nlohmann::json::parse(Loads(arguments).out);
    const auto columns = json["columns"].get<std::vector<std::string>>();
    for (const auto& joint : json["people"].at(0)["exposure"]) {
      const std::string name = joint["joint"].get<std::string>() + "_ratio";
      const auto column = static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) -
                                                   columns.begin());
      ASSERT_LT(column, columns.size()) << name;
      const std::array<double, 2> limits = {joint["above"][0]["limit"], joint["above"][1]["limit"]};
      std::vector<double> ratios;
      std::array<std::uint64_t, 4> counts{};
      for (const auto& sample : json["samples"]) {
        const bool is_known = !sample[column].is_null();
        const double ratio = is_known ? sample[column].get<double>() : 0;
        if (is_known) ratios.push_back(ratio);
        ++counts[!is_known ? 0 : ratio <= limits[0] ? 1 : ratio <= limits[1] ? 2 : 3];
      }
      const std::string trial = arguments.front() + " " + name;
      EXPECT_EQ(joint["samples"]["unknown"], counts[0]) << trial;
      EXPECT_EQ(joint["samples"]["low"], counts[1]) << trial;
      EXPECT_EQ(joint["samples"]["medium"], counts[2]) << trial;
      EXPECT_EQ(joint["samples"]["high"], counts[3]) << trial;
      if (ratios.empty()) continue;
      std::sort(ratios.begin(), ratios.end());
      const auto rank = [&](std::size_t percent) {
        return ratios[(percent * ratios.size() + 99) / 100 - 1];
      };
      EXPECT_EQ(joint["p10"], rank(10)) << trial;
      EXPECT_EQ(joint["p50"], rank(50)) << trial;
      EXPECT_EQ(joint["p90"], rank(90)) << trial;
      EXPECT_EQ(joint["peak_ratio"], ratios.back()) << trial;
    }
  }
}

TEST(LoadsCommand, PrintsATableWithMarkedAssumptions) {
  const ProgramResult result = Loads({"demo:lift", "--seconds", "1"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("75 kg (assumed)"));
  EXPECT_THAT(result.out, HasSubstr("Left ankle"));
  const ProgramResult given = Loads({"demo:lift", "--seconds", "1", "--sex", "male", "--mass", "75",
                                     "--hand_load", "none", "--height", "1.75"});
  EXPECT_THAT(given.out, Not(HasSubstr("assumed")));
}

TEST(LoadsCommand, PlotsEveryJointAsPngAndSvg) {
  const TempFolder folder;
  const auto plots = folder / "plots";
  ASSERT_EQ(Loads({"demo:lift", "--seconds", "0.5", "--plots", plots}).exit_code, 0);
  int pictures = 0;
  for (const int joint : urdf::kScoredJoints) {
    const std::string name(urdf::kJoints[urdf::At(joint)].ros_name);
    const render::Image image = render::ReadPng(plots / (name + ".png"));
    EXPECT_GT(image.width, 1000);
    const std::string svg = ReadFile(plots / (name + ".svg"));
    EXPECT_THAT(svg, HasSubstr("<svg"));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    ++pictures;
  }
  EXPECT_EQ(pictures, 15);
}

TEST(LoadsCommand, WritesASelfContainedReport) {
  const TempFolder folder;
  const std::string path = folder / "report.html";
  const ProgramResult result = Loads({"demo:lift", "--report", path});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string html = ReadFile(path);
  EXPECT_THAT(html, HasSubstr("Joint loads of one trial: demo:lift"));
  EXPECT_THAT(html, HasSubstr("body mass <b class=\"as\">75 kg, assumed</b>"));
  EXPECT_THAT(html, Not(HasSubstr("<script")));
  EXPECT_THAT(html, Not(HasSubstr("src=\"http")));
  std::size_t pictures = 0;
  for (std::size_t at = 0; (at = html.find("data:image/png;base64,", at)) != std::string::npos;
       ++at) {
    ++pictures;
  }
  EXPECT_EQ(pictures, 3U);
}

// Before the recording is read: a source that does not exist is not even looked for.
TEST(LoadsCommand, NamesThePackageThatPdfNeedsBeforeTheWorkBegins) {
  const TempFolder folder;
  const std::string path = folder / "report.pdf";
  const ProgramResult result =
      testing::RunProgram({"/usr/bin/env", "PATH=/nowhere", testing::KinescopePath(), "loads",
                           "/nowhere/recording.mvnx", "--report", path});
  ExpectRefusal(result, "--report=" + path);
  EXPECT_THAT(result.err, HasSubstr("apt install weasyprint"));
  EXPECT_THAT(result.err, HasSubstr(".html"));
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

// WeasyPrint unloads Pango at its end, whether or not a thread of Pango's still has to begin.
TEST(LoadsCommand, WritesAPdfAlthoughTheConverterEndsBeforeItsThreads) {
  const TempFolder folder;
  const std::string path = folder / "report.pdf";
  const ProgramResult result = testing::RunProgram(
      {testing::KinescopePath(), "loads", "demo:lift", "--seconds", "1", "--report", path},
      {"LD_PRELOAD=" +
       kinescope::testing::InBuild("tests/system/liblate_font_threads.so").string()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(ReadFile(path), ::testing::StartsWith("%PDF"));
}

TEST(LoadsCommand, ReportsWhyLegLoadsOfAnUpperBodyRecordingAreUnknown) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const std::string take = SharedData("mvnx/test_mocap.mvnx");
  const ProgramResult result = Loads({take, "--csv", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table(result.out);
  ASSERT_EQ(table.rows.size(), 112U);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.At(row, "right_knee_class"), "unknown");
    EXPECT_EQ(table.At(row, "right_knee_ratio"), "");
    EXPECT_THAT(table.At(row, "right_knee_reason"), HasSubstr("does not measure the legs"));
    EXPECT_FALSE(std::isnan(table.Number(row, "right_shoulder_ratio")));
    EXPECT_LT(std::abs(table.Number(row, "com_minus_mvn_z_m")), 0.005);
  }
  EXPECT_THAT(Loads({take}).out, HasSubstr("the source does not measure the legs"));
}

TEST(LoadsCommand, ReadsAFullBodyRecordingOfFourSamples) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/Meri-020.mvnx");
  const TempFolder folder;
  const std::string report = folder / "report.html";
  const ProgramResult result =
      Loads({SharedData("mvnx/Meri-020.mvnx"), "--json", "-", "--report", report});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["samples"].size(), 4U);
  EXPECT_LT(json["people"][0]["com_minus_mvn_m"]["most"], 0.005);
  EXPECT_THAT(ReadFile(report), HasSubstr("data:image/png"));
}

// A stream with nothing but poses has no accelerations: static, and it says so.
TEST(LoadsCommand, ComputesStaticLoadsWithTheReasonForAStreamOfPoses) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  const ProgramResult result = Loads({SharedData("udp/mxtp02.bin"), "--csv", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table(result.out);
  ASSERT_EQ(table.rows.size(), 1U);
  EXPECT_EQ(table.At(0, "is_dynamic"), "0");
  EXPECT_NE(table.At(0, "static_reason"), "");
  EXPECT_FALSE(std::isnan(table.Number(0, "right_shoulder_ratio")));
}

#ifdef KINESCOPE_WITH_ROS
TEST(LoadsCommand, ComputesStaticLoadsForABagOfPoses) {
  KINESCOPE_NEEDS_SHARED_DATA("ros1/2018-05-28-17-34-45.bag.xz");
  const ProgramResult result = Loads({SharedData("ros1/2018-05-28-17-34-45.bag.xz"), "--csv", "-"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable table(result.out);
  ASSERT_GT(table.rows.size(), 100U);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    EXPECT_EQ(table.At(row, "is_dynamic"), "0");
    EXPECT_NE(table.At(row, "static_reason"), "");
  }
  EXPECT_THAT(Loads({SharedData("ros1/2018-05-28-17-34-45.bag.xz")}).out,
              HasSubstr("load mode      static"));
}
#endif

TEST(LoadsCommand, EndsWithCodeOneIfNoLoadIsKnown) {
  const ProgramResult result =
      Loads({"demo:lift", "--seconds", "0.2", "--load_metric", "external"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("no external load received"));
}

// What the program computes for the feet, given back to it as measured.
TEST(LoadsCommand, ReproducesTheLoadsOfTheLegsFromItsOwnForcesOnTheFeet) {
  const TempFolder folder;
  const std::string forces = folder / "forces.csv";
  const std::vector<std::string> lift = {"demo:lift", "--seconds", "2", "--columns",
                                         "all",       "--csv",     "-"};
  const CsvTable computed(Loads(lift).out);
  {
    std::ofstream file(forces);
    file << "time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm,tz_Nm\n";
    for (std::size_t row = 0; row < computed.rows.size(); ++row) {
      for (const std::string side : {"right", "left"}) {
        const std::string foot = side + "_foot_";
        file << computed.At(row, "time_s") << (side == "right" ? ",RightFoot" : ",LeftFoot");
        for (const char* name : {"force_x_N", "force_y_N", "force_z_N", "cop_x_m", "cop_y_m"}) {
          file << ',' << computed.At(row, foot + name);
        }
        file << ',' << computed.At(row, "floor_z_m") << ",0,0,"
             << computed.At(row, foot + "free_moment_Nm") << '\n';
      }
    }
  }
  std::vector<std::string> arguments = lift;
  arguments.insert(arguments.end(), {"--wrenches", forces});
  const ProgramResult result = Loads(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const CsvTable measured(result.out);
  ASSERT_EQ(measured.rows.size(), computed.rows.size());
  for (std::size_t row = 0; row < measured.rows.size(); ++row) {
    EXPECT_EQ(measured.At(row, "ground_is_measured"), "1");
    EXPECT_EQ(computed.At(row, "ground_is_measured"), "0");
    for (const char* joint : {"right_hip", "left_knee", "right_ankle"}) {
      for (const char* axis : {"_moment_x_Nm", "_moment_y_Nm", "_moment_z_Nm"}) {
        EXPECT_NEAR(measured.Number(row, joint + std::string(axis)),
                    computed.Number(row, joint + std::string(axis)), 0.01);
      }
    }
  }
}

TEST(LoadsCommand, TellsTheTimeWithForcesFromAFileAndRefusesABadFile) {
  const TempFolder folder;
  const std::string forces = folder / "forces.csv";
  const auto write = [&](const std::string& rows) {
    std::ofstream(forces) << "time_s,body,fx_N,fy_N,fz_N,px_m,py_m,pz_m,tx_Nm,ty_Nm,tz_Nm\n"
                          << rows;
  };
  write("0,LeftHand,0,0,-50,,,,0,0,0\n0.1,LeftHand,0,0,-50,,,,0,0,0\n");
  const ProgramResult result = Loads({"demo:lift", "--seconds", "0.39", "--wrenches", forces});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("measured       forces.csv: left hand for 28 % of the time"));
  EXPECT_THAT(result.out, Not(HasSubstr("hand load: nothing")));
  EXPECT_THAT(result.out, HasSubstr("no data from the hand force sensor"));
  const ProgramResult late =
      Loads({"demo:lift", "--seconds", "0.2", "--wrenches", forces, "--wrench_offset", "7"});
  EXPECT_THAT(late.out, HasSubstr("forces.csv: none at the times of this person's samples"));

  write("0,LeftHand,0,0,x,,,,0,0,0\n");
  ExpectRefusal(Loads({"demo:lift", "--wrenches", forces}),
                "forces.csv: line 2: column fz_N: 'x': expected a number");
  ExpectRefusal(Loads({"demo:lift", "--wrench_offset", "1"}), "without --wrenches");
  ExpectRefusal(Kinescope({"serve", "demo:lift", "--wrenches", forces}), "wrenches");
}

TEST(LoadsCommand, RejectsInvalidOptionsInOneLine) {
  const auto refuses = [](const std::vector<std::string>& more, const std::string& named) {
    std::vector<std::string> arguments = {"demo:lift"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ExpectRefusal(Loads(arguments), named);
  };
  for (const char* mass : {"0", "-75", "nan", "1000"}) {
    refuses({"--mass", mass}, std::string("--mass=") + (mass[0] == 'n' ? "nan" : mass));
  }
  refuses({"--sex", "unknown"}, "--sex=unknown");
  refuses({"--hand_load", "right:500"}, "500");
  refuses({"--body_table", "tailor"}, "tailor");
  refuses({"--filter_hz", "100"}, "--filter_hz");
  refuses({"--seconds", "0"}, "--seconds=0");
  refuses({"--layout", "tall"}, "--layout=tall");
  refuses({"--joints", "all"}, "has no effect without --csv or --json");
  refuses({"--columns", "all"}, "has no effect without --csv or --json");
  refuses({"--csv", "-", "--json", "-"}, "standard output");
  refuses({"--csv", "/nowhere/at/all.csv"}, "/nowhere/at/all.csv");
  refuses({"--report", "/nowhere/at/all.html"}, "/nowhere/at/all.html");
  refuses({"--plots", "/proc/none"}, "/proc/none");
  ExpectRefusal(Loads({"udp://127.0.0.1:0"}), "live stream");
  ExpectRefusal(Loads({"/nowhere.mvnx"}), "/nowhere.mvnx");
}

TEST(LoadsCommand, NamesTheFileThatDoesNotFitOnTheDiskAndLeavesNothing) {
  const TempFolder folder;
  const std::string csv = folder / "loads.csv";
  // A limit in units of 512 bytes: less than the header.
  const ProgramResult result = testing::RunProgram({"/bin/sh", "-c", "ulimit -f 1; exec \"$@\"",
                                                    "sh", testing::KinescopePath(), "loads",
                                                    "demo:lift", "--seconds", "0.1", "--csv", csv});
  ExpectRefusal(result, csv);
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

TEST(LoadsCommand, ReportsThatStandardOutputIsFull) {
  for (const char* output : {"", "--csv -", "--json -"}) {
    const ProgramResult result = testing::RunProgram(
        {"/bin/sh", "-c",
         std::string("exec \"$0\" loads demo:lift --seconds 0.1 ") + output + " > /dev/full",
         testing::KinescopePath()});
    ExpectRefusal(result, "standard output");
  }
}

TEST(LoadsCommand, RejectsOneFileForTwoOutputs) {
  const TempFolder folder;
  const std::string file = folder / "loads", same = folder / "." / "none" / ".." / "loads";
  std::filesystem::create_directory(folder / "none");
  std::filesystem::create_directory_symlink(folder.path(), folder / "here");
  const std::string linked = folder / "here" / "loads";
  struct Pair {
    const char *one, *other;
    std::string spelling;
  };
  for (const Pair& pair : {Pair{"--csv", "--json", file}, Pair{"--csv", "--json", same},
                           Pair{"--csv", "--report", linked}, Pair{"--json", "--report", file},
                           Pair{"--json", "--plots", file + "/"}}) {
    const ProgramResult result =
        Loads({"demo:lift", "--seconds", "0.1", pair.one, file, pair.other, pair.spelling});
    ExpectRefusal(result, std::string(pair.one) + "=" + file + " and " + pair.other + "=" +
                              pair.spelling + " write to the same file");
  }
  EXPECT_THAT(folder.Names(), ::testing::ElementsAre("here", "none"));
}

TEST(LoadsCommand, LeavesNoFilesWhenItIsStopped) {
  const TempFolder folder;
  testing::Process child({testing::KinescopePath(), "loads", "demo:walk", "--seconds", "3600",
                          "--csv", "-", "--json", folder / "loads.json"});
  ASSERT_TRUE(child.ReadLine(std::chrono::seconds(60)));  // it has begun to write
  child.Signal(SIGINT);
  while (child.ReadLine(std::chrono::seconds(60))) {  // until it has ended
  }
  EXPECT_THAT(folder.Names(), ::testing::IsEmpty());
}

}  // namespace
}  // namespace kinescope
