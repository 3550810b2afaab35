#include "server/mvn/file/pcapng_blocks.h"

#include <cstddef>

namespace kinescope::mvn {
namespace {

constexpr std::uint32_t kSection = 0x0A0D0D0A, kInterface = 1, kStatistics = 5, kPacket = 6;
constexpr std::uint32_t kByteOrder = 0x1A2B3C4D;
constexpr std::uint16_t kEndOfOptions = 0, kComment = 1, kApplication = 4, kTimeResolution = 9;
constexpr std::uint16_t kRawIp = 101;  // LINKTYPE_RAW
constexpr std::uint32_t kSnapLength = 1 << 18;
constexpr char kNanoseconds = 9;  // 10^-9 s

// Little-endian on all machines; the byte order is stated in the file.
template <class Unsigned>
void Append(Unsigned value, std::string& out) {
  for (std::size_t i = 0; i < sizeof value; ++i) {
    out += static_cast<char>(static_cast<std::uint64_t>(value) >> 8 * i & 0xFF);
  }
}

// To whole words since `begin`.
void Pad(std::string& out, std::size_t begin) { out.append((begin - out.size()) % 4, '\0'); }

void AppendOption(std::uint16_t code, std::string_view value, std::string& out) {
  Append(code, out);
  Append(static_cast<std::uint16_t>(value.size()), out);
  const std::size_t begin = out.size();
  out += value;
  Pad(out, begin);
}

// Nothing without options.
void AppendComments(const std::vector<std::string>& comments, std::string& out) {
  constexpr std::size_t kLongest = 0xFFFF;
  for (const std::string& comment : comments) {
    std::size_t size = comment.size();
    if (size > kLongest) {
      size = kLongest;
      while (size > 0 && (static_cast<unsigned char>(comment[size]) & 0xC0) == 0x80) --size;
    }
    AppendOption(kComment, std::string_view(comment).substr(0, size), out);
  }
  if (!comments.empty()) AppendOption(kEndOfOptions, "", out);
}

// A block's length is in front of its body and behind it.
template <class AppendBody>
void AppendBlock(std::uint32_t type, std::string& out, AppendBody&& append_body) {
  const std::size_t begin = out.size();
  Append(type, out);
  Append(std::uint32_t{0}, out);
  append_body();
  const auto length = static_cast<std::uint32_t>(out.size() - begin + sizeof(std::uint32_t));
  Append(length, out);
  std::string bytes;
  Append(length, bytes);
  out.replace(begin + sizeof type, bytes.size(), bytes);
}

void AppendTime(std::int64_t wall_nanos, std::string& out) {
  const auto nanos = static_cast<std::uint64_t>(wall_nanos);
  Append(static_cast<std::uint32_t>(nanos >> 32), out);
  Append(static_cast<std::uint32_t>(nanos), out);
}

}  // namespace

void AppendPcapngHead(std::string& out) {
  AppendBlock(kSection, out, [&] {
    Append(kByteOrder, out);
    Append(std::uint16_t{1}, out);  // version 1.0
    Append(std::uint16_t{0}, out);
    Append(~std::uint64_t{0}, out);  // length unknown
    AppendOption(kApplication, "Kinescope", out);
    AppendOption(kEndOfOptions, "", out);
  });
  AppendBlock(kInterface, out, [&] {
    Append(kRawIp, out);
    Append(std::uint16_t{0}, out);
    Append(kSnapLength, out);
    AppendOption(kTimeResolution, std::string_view(&kNanoseconds, 1), out);
    AppendOption(kEndOfOptions, "", out);
  });
}

void AppendPcapngPacket(std::int64_t wall_nanos, std::string_view packet,
                        const std::vector<std::string>& comments, std::string& out) {
  AppendBlock(kPacket, out, [&] {
    Append(std::uint32_t{0}, out);  // the interface
    AppendTime(wall_nanos, out);
    Append(static_cast<std::uint32_t>(packet.size()), out);
    Append(static_cast<std::uint32_t>(packet.size()), out);
    const std::size_t begin = out.size();
    out += packet;
    Pad(out, begin);
    AppendComments(comments, out);
  });
}

void AppendPcapngEnd(std::int64_t wall_nanos, const std::vector<std::string>& comments,
                     std::string& out) {
  AppendBlock(kStatistics, out, [&] {
    Append(std::uint32_t{0}, out);
    AppendTime(wall_nanos, out);
    AppendComments(comments, out);
  });
}

}  // namespace kinescope::mvn
