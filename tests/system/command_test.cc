// What a user sees who gets it wrong, and the files that a user gets who gets it right.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>

#include "render/image/compare.h"
#include "render/image/png_file.h"
#include "server/picture/view_options.h"
#include "tests/folders.h"
#include "tests/process.h"
#include "tests/server/app/all_commands.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/run_program.h"
#include "tests/taken_port.h"
#include "tests/temp_folder.h"
#include "urdf/anatomical_limits.h"
#include "urdf/segments.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using testing::ProgramResult;
using testing::RestOfLine;
using testing::RunProgram;
using testing::SharedData;
using testing::TakenPort;
using testing::TempFolder;

TEST(Command, RejectsUnknownCommandsOptionsAndValuesByName) {
  ExpectRefusal(Kinescope({"frobnicate"}), "frobnicate");
  ExpectRefusal(Kinescope({"serve", "--prot", "3"}), "--prot");
  ExpectRefusal(Kinescope({"serve", "--http_port", "80a"}), "80a");
  ExpectRefusal(Kinescope({"bridge", "--tf", "sideways", "--ros", "off"}), "sideways");
  ExpectRefusal(Kinescope({"serve", "--mass", "500"}), "500");
  ExpectRefusal(Kinescope({}), "command missing: expected serve, bridge");
}

TEST(Command, RejectsOptionsWithoutEffect) {
  const TempFolder folder;
  const std::string png = folder.path() / "a.png";
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"render", "demo:walk", "--out", png, "--trail_secs", "3"}, "without --trail"},
      {{"render", "demo:walk", "--out", png, "--ghost_opacity", "0.5"}, "without --ghost"},
      {{"render", "demo:walk", "--out", png, "--title", "x", "--no_overlays"}, "--no_overlays"},
      {{"render", "demo:walk", "--out", png, "--fps", "25"}, "on a single picture"},
      {{"serve", "--udp_port", "9763", "--source", "demo:walk"}, "with --udp_port"},
      {{"serve", "--pictures", "off", "--picture_size", "320x240"}, "with --pictures=off"},
      {{"bridge", "--ros", "off", "--tf", "tree"}, "with --ros=off"},
      {{"loads", "demo:lift", "--layout", "long"}, "without --csv"},
      {{"stream", "demo:lift", "--seed", "3"}, "without --fault"},
  };
  for (const auto& [arguments, reason] : cases) {
    ExpectRefusal(Kinescope(arguments), "has no effect");
    ExpectRefusal(Kinescope(arguments), reason);
  }
  EXPECT_TRUE(folder.Names().empty());
}

TEST(Command, RejectsInvalidSources) {
  const TempFolder folder;
  const std::string text = folder.path() / "text.mvnx";
  std::ofstream(text) << "no XML at all\n";
  const std::string out = folder.path() / "a.png";
  ExpectRefusal(Kinescope({"render", "/nowhere.mvnx", "--out", out}), "/nowhere.mvnx");
  ExpectRefusal(Kinescope({"render", text, "--out", out}), text);
  ExpectRefusal(Kinescope({"render", "demo:fly", "--out", out}), "fly");
  ExpectRefusal(Kinescope({"render", "udp://:0", "--out", out}), "live stream");
  ExpectRefusal(Kinescope({"bridge", "--source", "udp://:99999"}), "99999");
  EXPECT_FALSE(fs::exists(out));
}

// The built-in subject has no end: it would be generated until then.
TEST(Command, RejectsTimesBeyondReachBeforeItReads) {
  const TempFolder folder;
  const std::string png = folder / "a.png", clip = folder / "a.mp4", csv = folder / "a.csv";
  const auto draw = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"render", "demo:walk", "--size", "16x16"});
    return Kinescope(more);
  };
  const std::string reach = "demo:walk is generated motion; expected at most 3600 s";
  ExpectRefusal(draw({"--out", png, "--time", "3601"}), "--time=3601: " + reach);
  ExpectRefusal(draw({"--out", png, "--sample", "432001"}), "--sample=432001: " + reach);
  ExpectRefusal(draw({"--out", clip, "--start", "800000"}), "--start=800000: " + reach);
  ExpectRefusal(draw({"--out", clip, "--seconds", "864000"}), "--seconds=864000: " + reach);
  ExpectRefusal(draw({"--out", clip, "--start", "3000", "--seconds", "601"}), "--seconds=601: ");
  ExpectRefusal(draw({"--out", clip, "--end", "4000"}), "--end=4000: " + reach);
  ExpectRefusal(draw({"--out", png, "--ghost", "demo:lift@800000"}),
                "--ghost=demo:lift@800000: demo:lift is generated motion; expected at most 3600 s");
  ExpectRefusal(Kinescope({"loads", "demo:walk", "--csv", csv, "--seconds", "3601"}),
                "--seconds=3601: " + reach);
  ExpectRefusal(Kinescope({"convert", "demo:walk", "--out", csv, "--seconds", "864000"}),
                "--seconds=864000: " + reach);
  ExpectRefusal(draw({"--out", png, "--sample", "2000000000"}),
                "--sample=2000000000: expected a whole number from 0 to 864000000");
  ExpectRefusal(draw({"--out", png, "--time", "1000000"}),
                "--time=1000000: expected a number from 0 to 864000 s");
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

TEST(Command, RejectsPortsThatAreInUse) {
  const TakenPort tcp(SOCK_STREAM), udp(SOCK_DGRAM);
  ExpectRefusal(
      Kinescope({"bridge", "--source", "udp://127.0.0.1:" + udp.number(), "--ros", "off"}),
      udp.number());
  const ProgramResult result = Kinescope({"serve", "--source", "udp://127.0.0.1:0", "--http_port",
                                          tcp.number(), "--ros", "off", "--pictures", "off"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr(tcp.number()));
}

// What is no datagram of a suit is counted by reason, and the suit's stream goes on.
TEST(Command, CountsRejectedDatagramsByReasonAndContinues) {
  testing::Process server({"/bin/bash", "-c",
                           "exec '" + testing::KinescopePath() +
                               "' serve --source udp://127.0.0.1:0 --http_port 0 "
                               "--ros off --pictures off 2>&1"});
  const std::string address = RestOfLine(server, "waiting for data from ");
  const std::string page = RestOfLine(server, "page at ");
  const std::string port =
      address.substr(address.rfind(':', address.find(": ") - 1) + 1, std::string::npos);
  const std::string to = "/dev/udp/127.0.0.1/" + port.substr(0, port.find(':'));
  const std::vector<std::string> rubbish = {"{\"type\":\"transport\"}", "GET / HTTP/1.0", "MXTP02",
                                            "MXTP02 says 23 segments follow and stops here"};
  for (const std::string& text : rubbish) {
    EXPECT_EQ(RunProgram({"/bin/bash", "-c", "printf %s '" + text + "' > " + to}).exit_code, 0);
  }
  const ProgramResult suit = Kinescope({"stream", "demo:n_pose", "--seconds", "1.2", "--to",
                                        "udp://127.0.0.1:" + port.substr(0, port.find(':'))});
  EXPECT_EQ(suit.exit_code, 0) << suit.err;
  // Counters are told twice a second; a busy machine takes longer.
  std::string diagnostics;
  nlohmann::json source;
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  do {
    diagnostics = RunProgram({"/usr/bin/curl", "-sf", page + "api/v1/diagnostics"}).out;
    source = nlohmann::json::parse(diagnostics).at("source");
  } while (source.at("samples") <= 100 && std::chrono::steady_clock::now() < deadline);
  EXPECT_GT(source.at("samples"), 100) << diagnostics;
  std::uint64_t rejected = 0;
  for (const auto& [reason, count] : source.at("rejected").items())
    rejected += count.get<std::uint64_t>();
  for (const auto& [reason, count] : source.at("ignored").items())
    rejected += count.get<std::uint64_t>();
  EXPECT_EQ(rejected, rubbish.size()) << diagnostics;
  EXPECT_GE(source.at("rejected").size(), 2u) << diagnostics;
}

TEST(Command, ReportsThatItCannotRender) {
  // A program without its module, as after half an installation.
  const TempFolder folder;
  const fs::path program = fs::path("libexec") / "kinescope" / "kinescope";
  fs::create_directories(folder / "bin");
  fs::create_directories((folder / program).parent_path());
  fs::create_directories(folder / "lib/kinescope");
  fs::copy(testing::KinescopePath(), folder / "bin/kinescope");
  fs::copy(fs::path(testing::KinescopePath()).parent_path().parent_path() / program,
           folder / program);
  std::ofstream(folder / "lib/kinescope/libkinescope_render_osmesa.so") << "not a library";
  const ProgramResult result = RunProgram(
      {folder / "bin/kinescope", "render", "demo:n_pose", "--out", folder.path() / "a.png"});
  ExpectRefusal(result, "libkinescope_render_osmesa.so");
  ExpectRefusal(Kinescope({"render", "demo:n_pose", "--out", folder.path() / "a.png"},
                          {"GALLIUM_DRIVER=hardware"}),
                "GALLIUM_DRIVER=hardware");
  EXPECT_FALSE(fs::exists(folder.path() / "a.png"));
}

TEST(Command, SaysHowToBuildTheProgramThatIsNotThereYet) {
  // As ./demo has it while the page is there and the rest is being built.
  const TempFolder folder;
  const fs::path program = fs::path("libexec") / "kinescope" / "kinescope";
  fs::create_directories(folder / "bin");
  fs::create_directories((folder / program).parent_path());
  fs::copy(testing::KinescopePath(), folder / "bin/kinescope");
  fs::copy(fs::path(testing::KinescopePath()).parent_path().parent_path() / program,
           folder / program);
  const auto there = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), folder / "bin/kinescope");
    return RunProgram(arguments);
  };
  ExpectRefusal(there({"golden", "check"}), "cmake --build ");
  EXPECT_EQ(there({"--help"}).out, Kinescope({"--help"}).out);
  EXPECT_EQ(there({"render", "--help"}).exit_code, 0);
}

TEST(Command, RejectsInvalidOutputs) {
  ExpectRefusal(Kinescope({"render", "demo:lift", "--out", "/nowhere/a.png"}), "/nowhere/a.png");
  ExpectRefusal(Kinescope({"render", "demo:lift", "--out", "a.avi"}), "a.avi");
  for (const char* size : {"0x0", "1000000x10", "wide"}) {
    ExpectRefusal(Kinescope({"render", "demo:lift", "--out", "a.png", "--size", size}), size);
  }
  ExpectRefusal(Kinescope({"golden", "check", "/nowhere"}), "/nowhere");
}

TEST(Command, NeverReplacesItsSource) {
  const TempFolder folder;
  const std::string take = folder / "take.mvnx", link = folder / "link.csv";
  ASSERT_EQ(Kinescope({"convert", "demo:lift", "--seconds", "0.1", "--out", take}).exit_code, 0);
  fs::create_hard_link(take, link);
  fs::copy_file(take, folder / "a.png.json");
  const auto size = fs::file_size(take);
  const std::vector<std::vector<std::string>> commands = {
      {"loads", take, "--csv", take},
      {"loads", take, "--csv", link},
      {"loads", take, "--json", folder.path() / "." / "take.mvnx"},
      {"convert", take, "--out", take},
      {"record", take, "--force", "--out", take + ".pcap"}};
  fs::create_symlink(take, take + ".pcap");
  for (const auto& arguments : commands) {
    ExpectRefusal(Kinescope(arguments), "output and source are the same file");
    EXPECT_EQ(fs::file_size(take), size);
  }
  const std::string png = folder / "a.png";
  ExpectRefusal(Kinescope({"render", png + ".json", "--out", png, "--time", "0"}),
                "output and source are the same file");
  ExpectRefusal(Kinescope({"render", take, "--out", png, "--time", "0"}),
                "is not a record of pictures");
  EXPECT_EQ(fs::file_size(png + ".json"), size);
}

// "| `urdf check` | one object per | members |" of docs/json.md: the members.
std::string DocumentedMembers(const std::string& command) {
  std::ifstream document(kinescope::testing::InSourceTree("docs/json.md"));
  for (std::string line; std::getline(document, line);) {
    const std::string begin = "| `" + command + "` |";
    if (line.compare(0, begin.size(), begin) == 0) return line.substr(line.find('|', begin.size()));
  }
  return "";
}

// The last cells of "| `right_knee`, `left_knee` | -20 to 170 | shank outwards, -25 to 25 | ... |".
TEST(Command, DocumentsTheRangesOfWrittenPoses) {
  std::ifstream document(kinescope::testing::InSourceTree("docs/pose.md"));
  const std::regex name("`([a-z0-9_]+)`"), range("(-?[0-9]+) to (-?[0-9]+)");
  std::set<int> documented;
  for (std::string line; std::getline(document, line);) {
    std::vector<std::string> cells;
    std::istringstream text(line);
    for (std::string cell; std::getline(text, cell, '|');) cells.push_back(cell);
    if (cells.size() != 5) continue;
    for (std::sregex_iterator at(cells[1].begin(), cells[1].end(), name), end; at != end; ++at) {
      for (int joint = 0; joint < urdf::kJointCount; ++joint) {
        if (urdf::kJoints[urdf::At(joint)].ros_name != (*at)[1].str()) continue;
        documented.insert(joint);
        const std::size_t cell_of_axis[] = {3, 4, 2};
        for (int axis = 0; axis < 3; ++axis) {
          std::smatch found;
          ASSERT_TRUE(std::regex_search(cells[cell_of_axis[axis]], found, range)) << line;
          const urdf::AngleRange actual = urdf::AnatomicalRangeOf(joint, axis);
          EXPECT_NEAR(std::stod(found[1]), actual.lower, 0.5) << line;
          EXPECT_NEAR(std::stod(found[2]), actual.upper, 0.5) << line;
        }
      }
    }
  }
  EXPECT_EQ(documented.size(), std::size_t{urdf::kJointCount});
}

TEST(Command, PrintsOneDocumentedJsonObjectPerLine) {
  const testing::TempFolder folder;
  const std::string still = folder / "a.png", clip = folder / "a.gif", urdf = folder / "p.urdf";
  ASSERT_EQ(Kinescope({"urdf", "--body_model", "primitive", "--out", urdf}).exit_code, 0);
  const std::map<std::string, std::vector<std::string>> commands = {
      {"render",
       {"demo:lift", "--size", "64x48", "--seconds", "0.1", "--out", still, "--out", clip}},
      {"stream", {"demo:lift", "--seconds", "0.05", "--to", "udp://127.0.0.1:9"}},
      {"urdf check", {urdf}},
      {"urdf picture", {urdf, "--size", "64x48", "--out", folder / "p.png"}},
      {"probe", {}}};
  for (const auto& [command, arguments] : commands) {
    std::vector<std::string> words;
    std::istringstream names(command);
    for (std::string name; names >> name;) words.push_back(name);
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.emplace_back("--json");
    const ProgramResult result = Kinescope(words);
    ASSERT_EQ(result.exit_code, 0) << command << ": " << result.err;
    const std::string documented = DocumentedMembers(command);
    std::istringstream lines(result.out);
    int objects = 0;
    for (std::string line; std::getline(lines, line); ++objects) {
      const auto object = nlohmann::json::parse(line, nullptr, false);
      ASSERT_TRUE(object.is_object()) << command << ": " << line;
      for (const auto& [key, value] : object.items()) {
        EXPECT_NE(documented.find("`" + key + "`"), std::string::npos)
            << command << ": " << key << " is not in docs/json.md";
      }
    }
    EXPECT_EQ(objects, command == "render" ? 2 : 1) << command;
  }
}

// The names below "Subcommands:" in what --help says.
std::set<std::string> SubcommandsIn(const std::string& help) {
  std::set<std::string> names;
  const std::size_t at = help.find("Subcommands:\n");
  if (at == std::string::npos) return names;
  std::istringstream lines(help.substr(at));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    if (line.size() > 2 && line[0] == ' ' && line[2] != ' ') {
      names.insert(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return names;
}

// Is "--name" there, and not only the beginning of a longer one?
bool HasOption(const std::string& help, const std::string& name) {
  const std::string flag = "--" + name;
  for (std::size_t at = help.find(flag); at != std::string::npos; at = help.find(flag, at + 1)) {
    const char next = (help + ' ')[at + flag.size()];
    if (next != '_' && next != '-' && std::isalnum(static_cast<unsigned char>(next)) == 0) {
      return true;
    }
  }
  return false;
}

TEST(Command, PrintsHelpForEveryOptionOfEveryCommand) {
  std::map<std::string, std::vector<std::string>> expected;
  const auto add = [&](const app::Command& command, const std::string& before,
                       auto&& self) -> void {
    expected[before + command.name];
    for (const options::Option& option : command.options) {
      if (option.group != options::kHidden) expected[before + command.name].push_back(option.name);
    }
    if (command.run != nullptr) expected[before + command.name].emplace_back("config");
    for (const app::Command& part : command.parts) self(part, before + command.name + " ", self);
  };
  for (const app::Command& command : testing::AllCommands()) add(command, "", add);

  std::set<std::string> met;
  std::vector<std::string> open = {""};  // commands whose help has not been read
  while (!open.empty()) {
    const std::string command = open.back();
    open.pop_back();
    std::vector<std::string> arguments;
    std::istringstream words(command);
    for (std::string word; words >> word;) arguments.push_back(word);
    arguments.emplace_back("--help");
    const ProgramResult result = Kinescope(arguments);
    EXPECT_EQ(result.exit_code, 0) << command;
    EXPECT_EQ(result.err, "") << command;
    for (const std::string& part : SubcommandsIn(result.out)) {
      open.push_back(command.empty() ? part : command + " " + part);
    }
    if (command.empty()) continue;
    met.insert(command);
    const auto options = expected.find(command);
    ASSERT_NE(options, expected.end()) << "'" << command << "' is not in the list of this test";
    for (const std::string& name : options->second) {
      EXPECT_TRUE(HasOption(result.out, name)) << command << " --help lacks --" << name;
    }
  }
  for (const auto& [command, options] : expected) {
    EXPECT_EQ(met.count(command), 1u) << "--help does not list '" << command << "'";
  }
}

TEST(Command, HelpIsAlsoACommand) {
  EXPECT_EQ(Kinescope({"help"}).out, Kinescope({"--help"}).out);
  EXPECT_EQ(Kinescope({"help", "golden", "check"}).out,
            Kinescope({"golden", "check", "--help"}).out);
  ExpectRefusal(Kinescope({"help", "rendr"}), "nearest: render");
}

TEST(Command, RendersTheSamePictureTwice) {
  const TempFolder folder;
  const std::string a = folder.path() / "a.png", b = folder.path() / "b.png";
  for (const std::string& out : {a, b}) {
    const ProgramResult result = Kinescope(
        {"render", "demo:lift", "--time", "2.5", "--size", "320x180", "--out", out, "--json"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("\"pictures\":1"));
  }
  EXPECT_EQ(testing::ReadFile(a), testing::ReadFile(b));
}

TEST(Command, RendersRealRecordings) {
  KINESCOPE_NEEDS_SHARED_DATA("mvnx/test_mocap.mvnx");
  const TempFolder folder;
  const std::string recording = SharedData("mvnx/test_mocap.mvnx");
  const std::string picture = folder.path() / "a.png", clip = folder.path() / "a.mp4";
  EXPECT_EQ(
      Kinescope({"render", recording, "--sample", "60", "--size", "320x180", "--out", picture})
          .exit_code,
      0);
  EXPECT_EQ(render::ReadPng(picture).width, 320);
  ExpectRefusal(Kinescope({"render", recording, "--sample", "112", "--out", picture}),
                "--sample=112");
  // 112 frames at 60 Hz end at 1.85 s: pictures 0 to 55 at 30 a second.
  const ProgramResult result = Kinescope(
      {"render", recording, "--size", "320x180", "--supersample", "1", "--out", clip, "--json"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("\"pictures\":56"));
}

TEST(Command, WritesAUrdfThatItsOwnCheckAccepts) {
  const TempFolder folder;
  const std::string file = folder.path() / "person.urdf";
  EXPECT_EQ(Kinescope({"urdf", "--height", "1.62", "--out", file}).exit_code, 0);
  const ProgramResult check = Kinescope({"urdf", "check", file});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("67 links, 66 joints, 75.000 kg"));
  const std::string text = testing::ReadFile(file);
  EXPECT_EQ(Kinescope({"urdf", "--height", "1.62", "--out", "-"}).out, text);
  std::ofstream(file) << "<robot/>";
  EXPECT_EQ(Kinescope({"urdf", "check", file}).exit_code, 1);
}

}  // namespace
}  // namespace kinescope
