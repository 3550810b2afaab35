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

// tests/fuzz/CMakeLists.txt renames LLVMFuzzerTestOneInput of each source.
using Entry = int(const std::uint8_t* data, std::size_t size);
extern "C" Entry Fuzz_assembler, Fuzz_bag, Fuzz_camera_keys, Fuzz_datagram, Fuzz_framing,
    Fuzz_http_target, Fuzz_loads, Fuzz_marks, Fuzz_mesh_file, Fuzz_mvnx, Fuzz_options,
    Fuzz_page_message, Fuzz_pcap, Fuzz_rig, Fuzz_scale, Fuzz_urdf, Fuzz_websocket, Fuzz_wrenches,
    Fuzz_yaml_options;
#ifdef KINESCOPE_WITH_ROS
extern "C" Entry Fuzz_marker;
#endif

int main(int argc, char** argv) {
  const std::map<std::string, Entry*> entries = {
      {"assembler", &Fuzz_assembler},
      {"bag", &Fuzz_bag},
      {"camera_keys", &Fuzz_camera_keys},
      {"datagram", &Fuzz_datagram},
      {"framing", &Fuzz_framing},
      {"http_target", &Fuzz_http_target},
      {"loads", &Fuzz_loads},
      {"marks", &Fuzz_marks},
      {"mesh_file", &Fuzz_mesh_file},
      {"mvnx", &Fuzz_mvnx},
      {"options", &Fuzz_options},
      {"page_message", &Fuzz_page_message},
      {"pcap", &Fuzz_pcap},
      {"rig", &Fuzz_rig},
      {"scale", &Fuzz_scale},
      {"urdf", &Fuzz_urdf},
      {"websocket", &Fuzz_websocket},
      {"wrenches", &Fuzz_wrenches},
      {"yaml_options", &Fuzz_yaml_options},
#ifdef KINESCOPE_WITH_ROS
      {"marker", &Fuzz_marker},
#endif
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
