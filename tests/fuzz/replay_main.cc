// Runs one fuzz entry over every file of a folder, where no fuzzing engine is linked in:
// fuzz_replay ENTRY FOLDER
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

// tests/fuzz/CMakeLists.txt renames LLVMFuzzerTestOneInput of each source and writes the list
// of them: FUZZ_ENTRY(name) a line.
using Entry = int(const std::uint8_t* data, std::size_t size);
#define FUZZ_ENTRY(name) extern "C" Entry Fuzz_##name;
#include "fuzz_entries.inc"
#undef FUZZ_ENTRY

int main(int argc, char** argv) {
  const std::map<std::string, Entry*> entries = {
#define FUZZ_ENTRY(name) {#name, &Fuzz_##name},
#include "fuzz_entries.inc"
#undef FUZZ_ENTRY
  };
  const auto entry = argc == 3 ? entries.find(argv[1]) : entries.end();
  if (entry == entries.end()) {
    std::fprintf(stderr, "usage: fuzz_replay ENTRY FOLDER\n");
    return 2;
  }
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(argv[2])) {
    std::ifstream in(file.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    // Named first: when an entry aborts, the last line tells which file did it.
    std::printf("%s\n", file.path().c_str());
    std::fflush(stdout);
    entry->second(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
    ++files;
  }
  std::printf("%d files replayed\n", files);
  return files > 0 ? 0 : 1;  // an empty corpus would test nothing
}
