#include "server/mvn/file/recording.h"

#include <algorithm>
#include <utility>

#include "core/system/errors.h"
#include "server/mvn/datagram_extent.h"
#include "server/mvn/file/pcap_datagrams.h"
#include "server/mvn/file/raw_file_datagrams.h"

namespace kinescope::mvn {
namespace {

using namespace std::string_view_literals;

struct Magic {
  std::string_view bytes;
  const char* name;
};

// Both byte orders, microseconds and nanoseconds, and the format with longer packet headers.
constexpr std::string_view kCaptures[] = {
    "\xa1\xb2\xc3\xd4"sv, "\xd4\xc3\xb2\xa1"sv, "\xa1\xb2\x3c\x4d"sv, "\x4d\x3c\xb2\xa1"sv,
    "\xa1\xb2\xcd\x34"sv, "\x34\xcd\xb2\xa1"sv, "\x0a\x0d\x0d\x0a"sv,
};

// Formats that users try, and the supported alternative.
constexpr Magic kRelatives[] = {
    {"PK\x03\x04"sv, "a zip archive; extract it first"},
    {"HIERARCHY"sv, "BVH, which does not contain MVN segments; export the recording as MVNX"},
};

constexpr const char* kRecordings =
    "MVNX, a capture (pcap, pcapng), concatenated MVN datagrams (.bin) or a ROS bag";

bool BeginsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool IsXml(std::string_view head) {
  for (const auto mark : {"\xef\xbb\xbf"sv, "\xff\xfe"sv, "\xfe\xff"sv}) {
    if (BeginsWith(head, mark)) return true;
  }
  const std::size_t first = head.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && head[first] == '<';
}

// "MXTP" and two digits anywhere: a stream may be cut at its beginning, or start with sync text.
bool HasDatagram(std::string_view head) { return FindIdString(head, 0) != head.npos; }

}  // namespace

RecordingKind KindOf(std::string_view head) {
  if (head.empty()) return RecordingKind::kEmpty;
  for (const std::string_view magic : kCaptures) {
    if (BeginsWith(head, magic)) return RecordingKind::kPcap;
  }
  if (BeginsWith(head, "#ROSBAG")) return RecordingKind::kRosBag;
  // Checked before XML, because a stream may begin with sync text in XML.
  if (HasDatagram(head)) return RecordingKind::kDatagrams;
  if (IsXml(head)) return RecordingKind::kMvnx;
  return RecordingKind::kUnknown;
}

std::string DescribeUnfit(const std::string& path, std::string_view head,
                          const std::string& wanted) {
  const std::string name = NameOfInput(path);
  if (head.empty()) return name + ": the file is empty";
  for (const Magic& magic : kRelatives) {
    if (BeginsWith(head, magic.bytes)) return name + ": is " + magic.name;
  }
  return name + ": unknown file format; expected " + wanted;
}

std::unique_ptr<DatagramSource> OpenRecording(InputFile file, const std::string& name) {
  switch (KindOf(file.head())) {
    case RecordingKind::kPcap: return std::make_unique<PcapDatagrams>(std::move(file), name);
    case RecordingKind::kDatagrams:
      return std::make_unique<RawFileDatagrams>(std::move(file), name);
    default: throw SourceError(DescribeUnfit(name, file.head(), kRecordings));
  }
}

}  // namespace kinescope::mvn
