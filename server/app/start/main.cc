// The program that people start. It compares two pictures itself, which tests do thousands of
// times; for everything else it becomes the program that has the command, whose ninety libraries
// take longer to load than two pictures to compare.
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

#include "core/system/standard_streams.h"
#include "core/system/utf8.h"
#include "server/app/command_table.h"
#include "server/app/golden/golden_compare.h"
#include "server/app/print.h"

namespace {

using namespace kinescope;

// `golden compare A B`, without options.
bool IsPlainComparison(int argc, char** argv) {
  if (argc != 5 || std::string(argv[1]) != "golden" || std::string(argv[2]) != "compare") {
    return false;
  }
  return argv[3][0] != '-' && argv[4][0] != '-';
}

// Pixels come into memory that was never used. The kernel provides it page by page, which takes as
// long as comparing them unless pages are large.
void UseLargePages() {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kPage = std::size_t{2} << 20;
  ::mallopt(M_ARENA_MAX, 1);
  ::mallopt(M_MMAP_THRESHOLD, 32 << 20);
  ::mallopt(M_TOP_PAD, static_cast<int>(kBytes));
  ::mallopt(M_TRIM_THRESHOLD, static_cast<int>(2 * kBytes));
  void* volatile grows = std::malloc(std::size_t{1} << 20);
  std::free(grows);
  char* const top = static_cast<char*>(::sbrk(0));
  char* const end = top - reinterpret_cast<std::uintptr_t>(top) % kPage;
  // Without them it is only slower.
  static_cast<void>(::madvise(end - kBytes + kPage, kBytes - kPage, MADV_HUGEPAGE));
}

int Compare(const char* one, const char* other) {
  UseLargePages();
  const app::PictureVerdict verdict = app::ComparePictures(one, other, "");
  for (const std::string& line : app::LinesOf(verdict)) app::Print("{}\n", line);
  FlushStandardOutput();
  return verdict.is_same ? 0 : 1;
}

// The command is the first word that names one: words before it, such as "help", are for the
// program that has it.
std::string CommandOf(int argc, char** argv) {
  const auto words = argv + argc;
  const auto word = std::find_if(argv + std::min(argc, 1), words, [](const char* each) {
    return app::FindCommand(each) != nullptr;
  });
  return word == words ? "" : *word;
}

[[noreturn]] void Become(const std::filesystem::path& program, char** argv) {
  ::execv(program.c_str(), argv);
  throw std::runtime_error("cannot start " + program.string() + ": " +
                           std::generic_category().message(errno));
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (!IsPlainComparison(argc, argv)) Become(app::ProgramOf(CommandOf(argc, argv)), argv);
    OpenStandardStreams();
    std::signal(SIGPIPE, SIG_IGN);
    return Compare(argv[3], argv[4]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinescope: %s\n", PrintableLine(error.what()).c_str());
    return 2;
  }
}
