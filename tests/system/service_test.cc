// The program as a service manager, a container or a script starts it: without a home, a terminal
// or space on the disk.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/process.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/run_program.h"
#include "tests/taken_port.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using testing::ExpectRefusal;
using ::testing::HasSubstr;
using testing::Kinescope;
using testing::ProgramResult;
using testing::RestOfLine;
using testing::RunProgram;
using testing::TakenPort;
using testing::TempFolder;

// `{}` in `script` is the program.
ProgramResult InShell(const std::string& script, const std::vector<std::string>& environment = {}) {
  return RunProgram({"/bin/bash", "-c", fmt::format(script, testing::KinescopePath())},
                    environment);
}

// Of no account: not even root can create it.
constexpr char kNoHome[] = "HOME=/proc/nothere";

TEST(Service, NeedsNeitherAHomeNorALocale) {
  const TempFolder folder;
  const std::string png = folder / "a.png", csv = folder / "a.csv", urdf = folder / "a.urdf";
  const std::vector<std::vector<std::string>> commands = {
      {"--version"},
      {"--help"},
      {"render", "demo:lift", "--size", "64x48", "--out", png},
      {"convert", "demo:lift", "--seconds", "0.1", "--out", csv},
      {"inspect", "demo:lift", "--seconds", "0.1"},
      {"urdf", "--body_model", "primitive", "--out", urdf},
      {"urdf", "--out", folder / "person"},
      {"stream", "demo:lift", "--seconds", "0.05", "--to", "udp://127.0.0.1:9"}};
  for (const auto& arguments : commands) {
    const ProgramResult result =
        Kinescope(arguments, {kNoHome, "XDG_CACHE_HOME=/proc/nothere", "LC_ALL=nonexistent"});
    EXPECT_EQ(result.exit_code, 0) << arguments[0] << ": " << result.err;
  }
}

TEST(Service, RosNeedsNoHomeEither) {
  testing::Process bridge({"/bin/bash", "-c",
                           fmt::format("{} exec '{}' bridge --source udp://127.0.0.1:0 2>&1",
                                       kNoHome, testing::KinescopePath())});
  EXPECT_NE(RestOfLine(bridge, "listening at "), "");
}

TEST(Service, RemappingsAreTakenFromTheArgumentsOfEveryCommand) {
  EXPECT_EQ(Kinescope({"inspect", "demo:lift", "--seconds", "0.05", "__name:=a", "_b:=c", "d:=e"})
                .exit_code,
            0);
}

TEST(Service, AClosedInputOrOutputIsNotUsedForSocketsAndFiles) {
  const TempFolder folder;
  const ProgramResult result = RunProgram(
      {"/bin/bash", "-c",
       fmt::format("cd '{}'; mkfifo log; '{}' serve --source udp://127.0.0.1:0 --http_port 0 "
                   "--ros off --pictures off <&- >&- 2>log & exec 4<log; "
                   "while read -r line <&4; do [[ $line == *'page at'* ]] && break; done; "
                   "readlink /proc/$!/fd/0 /proc/$!/fd/1; kill $!; wait $!; echo exit $?",
                   folder.path().string(), testing::KinescopePath())});
  EXPECT_EQ(result.out, "/dev/null\n/dev/null\nexit 0\n") << result.err;
}

TEST(Service, StandardOutputThatCannotBeWrittenIsAnError) {
  const TempFolder folder, cases;
  const std::string png = folder / "a.png", urdf = folder / "a.urdf", pcap = folder / "a.pcap";
  std::ofstream(cases / "bend.yaml") << "source: demo:lift\nsize: 64x48\n";
  ASSERT_EQ(Kinescope({"urdf", "--body_model", "primitive", "--out", urdf}).exit_code, 0);
  const std::vector<std::string> commands = {
      "--version",
      "--help",
      "help golden",
      "render --help",
      "render demo:lift --size 64x48 --out " + png,
      "render demo:lift --size 64x48 --json --force --out " + png,
      "inspect demo:lift --seconds 0.05",
      "inspect demo:lift --seconds 0.05 --json",
      "loads demo:lift --seconds 0.1",
      "loads demo:lift --seconds 0.1 --csv -",
      "loads demo:lift --seconds 0.1 --json -",
      "urdf --body_model primitive",
      "urdf --body_model primitive --out " + urdf,
      "urdf check " + urdf,
      "urdf check --json " + urdf,
      "urdf picture " + urdf + " --size 64x48 --json --out " + png,
      "strip --out - " + png,
      "strip --json --out - " + png,
      "stream demo:lift --seconds 0.05 --json --to udp://127.0.0.1:9",
      "record udp://127.0.0.1:0 --seconds 0.01 --json --out " + pcap,
      "golden check " + cases.path().string(),
      "golden check --json " + cases.path().string()};
  for (const std::string& arguments : commands) {
    const ProgramResult result = InShell("exec '{}' " + arguments + " > /dev/full");
    EXPECT_EQ(result.exit_code, 2) << arguments << ": " << result.err;
  }
}

TEST(Service, AClosedTerminalEndsEveryLongCommandAsSigtermDoes) {
  const TempFolder folder;
  const std::string pcap = folder / "take.pcap";
  const std::vector<std::pair<std::string, std::string>> commands = {
      {"serve --source udp://127.0.0.1:0 --http_port 0 --ros off --pictures off", "page at "},
      {"bridge --source udp://127.0.0.1:0 --ros off", "listening at "},
      {"inspect udp://127.0.0.1:0 --seconds 60", "listening at "},
      {"record udp://127.0.0.1:0 --force --out " + pcap, "recording "},
      {"stream demo:lift --seconds 60 --to udp://127.0.0.1:9", "streaming "}};
  for (const auto& [arguments, ready] : commands) {
    for (const int signal : {SIGHUP, SIGTERM}) {
      testing::Process shell({"/bin/bash", "-c",
                              fmt::format("'{}' {} 2>&1 & echo pid $!; wait $!; echo exit $?",
                                          testing::KinescopePath(), arguments)});
      const pid_t program = std::stoi(RestOfLine(shell, "pid "));
      RestOfLine(shell, ready);
      kill(program, signal);
      const std::string code = RestOfLine(shell, "exit ");
      EXPECT_LE(std::stoi(code), 1) << arguments << " after signal " << signal;
    }
  }
  EXPECT_FALSE(fs::exists(pcap)) << "nothing was received";
}

TEST(Service, ALogThatNobodyReadsAnyMoreEndsNothing) {
  const ProgramResult result = InShell(
      "exec 3< <(exec '{0}' serve --source udp://127.0.0.1:0 --http_port 0 --ros off --pictures off"
      " 2>&1); program=$!; read -r line <&3; exec 3<&-; "
      "kill -HUP $program; wait $program; echo exit $?");
  EXPECT_EQ(result.out, "exit 0\n") << result.err;
}

// As of any other program.
TEST(Service, ResultsThatNobodyReadsAnyMoreEndACommandWithoutAWord) {
  for (const std::string command : {"--help", "loads demo:lift --seconds 20 --csv -"}) {
    const ProgramResult result = InShell("'{}' " + command + " | read -r -n 1; echo $PIPESTATUS");
    EXPECT_EQ(result.err, "") << command;
  }
}

// Mesa maps its index; storing to a page of a full disk ends a process with SIGBUS.
TEST(Service, AFullDiskUnderTheShaderCacheEndsNoProcess) {
  if (!testing::CanMount()) GTEST_SKIP() << "unshare -rm is not permitted here";
  const TempFolder folder;
  fs::create_directory(folder / "cache");
  // 12 kB are left: enough for the folder of the cache, but not for all keys of its index.
  const std::string script = fmt::format(
      "cd '{0}'; mount -t tmpfs -o size=1m none cache; head -c 1036288 /dev/zero > cache/filler; "
      "XDG_CACHE_HOME='{0}/cache' '{1}' render demo:lift --body_model primitive --size 64x48 "
      "--out a.png",
      folder.path().string(), testing::KinescopePath());
  const ProgramResult result = RunProgram({"/usr/bin/unshare", "-rm", "/bin/bash", "-c", script});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("No space left on device")) << "it was silent about the cache";
  EXPECT_TRUE(fs::exists(folder / "a.png"));
}

// Meshes are files for other programs only; `render` has no readers.
TEST(Service, PicturesWriteOnlyCompiledShadersIntoTheCacheOfTheService) {
  const TempFolder cache, out;
  const ProgramResult result =
      InShell("exec env -u HOME -u XDG_CACHE_HOME CACHE_DIRECTORY='" + cache.path().string() +
              "' '{}' render demo:lift --size 64x48 --out " + (out / "a.png").string());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_THAT(cache.Names(), ::testing::ElementsAre("mesa_shader_cache"));
  EXPECT_FALSE(fs::is_empty(cache / "mesa_shader_cache"));
}

TEST(Service, APortInUseIsReportedBeforeTheFirstPicture) {
  const TakenPort used(SOCK_STREAM);
  ExpectRefusal(Kinescope({"serve", "--source", "demo:lift", "--http_port", used.number(), "--ros",
                           "off", "--picture_size", "64x48"}),
                used.number());
  ExpectRefusal(Kinescope({"serve", "--source", "demo:lift", "--bind_ip", "192.0.2.1", "--token",
                           "0123456789abcdef", "--http_port", "0", "--ros", "off"}),
                "192.0.2.1");
  ExpectRefusal(
      Kinescope({"serve", "--source", "demo:lift", "--bind_ip", "0.0.0.0", "--ros", "off"}),
      "--token");
}

TEST(Service, AnOutputThatCannotBeWrittenIsReportedBeforeAnythingIsDrawn) {
  // With this driver, drawing would fail first.
  for (const char* out : {"/nowhere/a.png", "/dev/null/a.mp4"}) {
    ExpectRefusal(Kinescope({"render", "demo:lift", "--out", out}, {"GALLIUM_DRIVER=none"}), out);
  }
}

TEST(Service, ARecordingOfNothingEndsWithOneAndSaysWhatToCheck) {
  const TempFolder folder;
  const ProgramResult result = Kinescope(
      {"record", "udp://127.0.0.1:0", "--seconds", "0.1", "--out", folder / "take.pcap", "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_THAT(result.err, AllOf(HasSubstr("udp://127.0.0.1:"), HasSubstr("no datagrams received"),
                                HasSubstr("Network Streamer"), HasSubstr("firewall")));
  EXPECT_THAT(result.out, HasSubstr("\"datagrams\":0"));
}

}  // namespace
}  // namespace kinescope
