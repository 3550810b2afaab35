#include "server/app/golden/golden_stress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>

#include "core/system/scratch_folder.h"
#include "core/system/stop_signal.h"
#include "core/system/words.h"
#include "render/image/png_file.h"
#include "server/app/golden/finding.h"
#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_run.h"
#include "server/app/golden/golden_suite.h"
#include "server/app/print.h"
#include "server/picture/child_process.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::minutes kMostPerCase(2);

struct Circumstance {
  std::string name;
  std::vector<std::string> before;  // words before the program
  std::string why_not;              // not empty: it cannot be tried on this machine
};

std::vector<std::string> With(std::vector<std::string> words) {
  words.insert(words.begin(), "/usr/bin/env");
  return words;
}

bool IsInstalled(const char* locale) {
  const locale_t found = ::newlocale(LC_ALL_MASK, locale, nullptr);
  if (found != nullptr) ::freelocale(found);
  return found != nullptr;
}

// Few machines have the locale, but Debian's package `locales` has its sources.
Circumstance DecimalCommas(const fs::path& scratch) {
  constexpr char kLocale[] = "de_DE.UTF-8";
  Circumstance commas = {"locale with decimal commas",
                         With({std::string("LC_ALL=") + kLocale, std::string("LANG=") + kLocale}),
                         ""};
  if (IsInstalled(kLocale)) return commas;
  const fs::path locales = scratch / "locales";
  fs::create_directories(locales);
  const ChildResult made = RunChild(With({"localedef", "--no-archive", "--inputfile=de_DE",
                                          "--charmap=UTF-8", (locales / kLocale).string()}),
                                    std::chrono::minutes(1));
  commas.before.push_back("LOCPATH=" + locales.string());
  if (made.exit_code != 0 || made.signal != 0) {
    commas.why_not = std::string(kLocale) + " is not installed (apt-get install locales)";
  }
  return commas;
}

// A folder in which this user cannot write; the superuser can in all that permissions protect.
fs::path ReadOnlyHome(const fs::path& scratch) {
  if (::geteuid() == 0) return "/proc";
  fs::path home = scratch / "home";
  fs::create_directories(home);
  fs::permissions(home, fs::perms::owner_read | fs::perms::owner_exec);
  return home;
}

// By coreutils, which every Debian has.
std::vector<Circumstance> Circumstances(const fs::path& scratch) {
  const fs::path home = ReadOnlyHome(scratch);
  std::vector<Circumstance> all;
  for (const char* threads : {"0", "1", "2", "4", "8"}) {
    all.push_back({fmt::format("{} filling threads", threads),
                   With({std::string("LP_NUM_THREADS=") + threads}), ""});
  }
  all.push_back(DecimalCommas(scratch));
  all.push_back({"time zone Asia/Kathmandu", With({"TZ=Asia/Kathmandu"}), ""});
  all.push_back({"working folder /", With({"-C", "/"}), ""});
  all.push_back({"read-only home",
                 With({"HOME=" + home.string(), "XDG_CACHE_HOME=" + (home / "cache").string()}),
                 ""});
  all.push_back({"lowest priority", {"/usr/bin/nice", "-n", "19"}, ""});
  return all;
}

double DistanceTo(const ObjectFact& object, double x_px, double y_px) {
  return std::hypot(object.x_px - x_px, object.y_px - y_px);
}

// Where pictures of equal size, whose objects are the same, differ: "2 pixels differ, the first at
// x 120, y 45, nearest to right_knee".
std::string FirstDifference(const render::Image& before, const render::Image& now,
                            const PictureFacts& facts) {
  std::int64_t pixels = 0, first = 0;
  for (std::int64_t i = 4 * std::int64_t{now.width} * now.height - 4; i >= 0; i -= 4) {
    if (std::memcmp(&before.rgba[static_cast<std::size_t>(i)],
                    &now.rgba[static_cast<std::size_t>(i)], 4) == 0) {
      continue;
    }
    ++pixels;
    first = i / 4;
  }
  const std::int64_t column = first % now.width, row = first / now.width;
  const auto x_px = static_cast<double>(column), y_px = static_cast<double>(row);
  const auto nearest = std::min_element(
      facts.objects.begin(), facts.objects.end(), [&](const ObjectFact& a, const ObjectFact& b) {
        return DistanceTo(a, x_px, y_px) < DistanceTo(b, x_px, y_px);
      });
  return fmt::format("{} {}, the first at x {}, y {}{}",
                     Counted(static_cast<std::uint64_t>(pixels), "pixel"),
                     pixels == 1 ? "differs" : "differ", x_px, y_px,
                     nearest == facts.objects.end() ? "" : ", nearest to " + nearest->name);
}

class Stress {
 public:
  explicit Stress(const StressSettings& settings)
      : settings_(settings), suite_(FindGoldenSuite(settings.folder, settings.names)) {}

  int Run() {
    const auto circumstances = Circumstances(scratch_.path());
    first_ = Draw({"/usr/bin/env"}, FirstRun());
    Print("{}, drawn under {} circumstances{}:\n", Counted(first_.size(), "picture"),
          circumstances.size(),
          settings_.rounds == 1 ? "" : fmt::format(", {} times", settings_.rounds));
    for (const auto& [name, each] : first_) {
      if (!each.now) {
        Print("  {}: could not be drawn and is left out; `kinescope golden check` says why\n",
              name);
      }
    }
    for (int round = 0; round < settings_.rounds; ++round) {
      for (const Circumstance& each : circumstances) {
        if (StopRequested()) throw std::runtime_error("interrupted");
        if (each.why_not.empty()) {
          CompareWith(each);
        } else {
          Print("{:<28} not tried: {}\n", each.name, each.why_not);
        }
      }
    }
    return exit_code_;
  }

 private:
  using Drawn = std::map<std::string, CaseVerdict>;

  fs::path FirstRun() const { return scratch_ / "first"; }

  // In a process of its own, whose environment is another one.
  Drawn Draw(std::vector<std::string> command, const fs::path& out) {
    command.push_back(fs::read_symlink("/proc/self/exe").string());
    command.insert(command.end(), {"golden", "check", fs::absolute(settings_.folder).string()});
    for (const FoundCase& found : suite_.cases) command.push_back(found.name);
    command.insert(command.end(), {"--out", out.string(), "--backend", settings_.backend,
                                   "--all_pictures", "--json"});
    const ChildResult child =
        RunChild(command, kMostPerCase * static_cast<int>(suite_.cases.size()),
                 [] { return !StopRequested(); });
    if (child.signal != 0 || child.was_too_slow) {
      throw std::runtime_error(child.was_too_slow
                                   ? "drawing took too long"
                                   : fmt::format("drawing ended with signal {}", child.signal));
    }
    Drawn drawn;
    for (CaseVerdict& each : ReadRun(out).verdicts) {
      if (!each.now) SetExitCode(2);
      drawn[each.name] = std::move(each);
    }
    return drawn;
  }

  void CompareWith(const Circumstance& circumstance) {
    const fs::path run = scratch_ / "run";
    const Drawn drawn = Draw(circumstance.before, run);
    std::vector<std::string> lines;
    std::size_t compared = 0;
    for (const auto& [name, each] : drawn) {
      const auto& before = first_[name].now;
      if (!before) continue;
      ++compared;
      if (!each.now) {
        lines.push_back(name + ": could not be drawn so: " + each.reason);
      } else if (each.now->pixels_sha256 != before->pixels_sha256) {
        SetExitCode(1);
        const auto findings = Compare(before->facts, each.now->facts);
        lines.push_back(fmt::format(
            "{}: {}", name,
            findings.empty()
                ? FirstDifference(render::ReadPng(NewPictureOf(FirstRun(), name)),
                                  render::ReadPng(NewPictureOf(run, name)), each.now->facts)
                : findings.front().text));
      }
    }
    Print("{:<28} {}\n", circumstance.name,
          lines.empty() ? fmt::format("{} the same", compared) : "DIFFERS");
    for (const std::string& line : lines) Print("  {}\n", line);
  }

  // 2 wins: the verdict is not known then.
  void SetExitCode(int code) { exit_code_ = std::max(exit_code_, code); }

  const StressSettings& settings_;
  const GoldenSuite suite_;
  const ScratchFolder scratch_;
  Drawn first_;
  int exit_code_ = 0;
};

}  // namespace

int StressSuite(const StressSettings& settings) { return Stress(settings).Run(); }

}  // namespace kinescope::app
