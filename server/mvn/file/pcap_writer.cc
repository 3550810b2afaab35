#include "server/mvn/file/pcap_writer.h"

#include <fcntl.h>
#include <pcap/pcap.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/words.h"
#include "server/mvn/file/packet.h"
#include "server/mvn/file/pcapng_blocks.h"

namespace kinescope::mvn {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kFlushBytes = 64 * 1024;
constexpr int kLongestPacket = 1 << 18;                              // the limit of libpcap
constexpr std::int64_t kLatestNanos = 0xFFFFFFFF * kNanosPerSecond;  // the limit of the format

[[noreturn]] void RefuseToCreate(const fs::path& path, int error) {
  const char* way_out = "";
  switch (error) {
    case EEXIST: way_out = "; choose another name, or use --force to replace it"; break;
    case ENOENT: way_out = "; create its folder first"; break;
    case EACCES: way_out = "; choose a folder with write permission"; break;
    default: break;
  }
  throw SourceError(path.string() + ": cannot create the file: " + std::strerror(error) + way_out);
}

bool IsDeviceOrPipe(const fs::path& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

bool IsPcapng(const fs::path& path) { return path.extension() == ".pcapng"; }

// One capture file. libpcap, or AppendPcapng*(), writes into `pending_`, from which complete
// packets are passed to the kernel.
class PcapWriter::File {
 public:
  /// @throws std::system_error
  File(const fs::path& path, bool replace) : is_special_(IsDeviceOrPipe(path)) {
    const int creation = is_special_ ? 0 : O_CREAT | (replace ? O_TRUNC : O_EXCL);
    constexpr int kMode = 0644;
    descriptor_ = open(path.c_str(), O_WRONLY | O_CLOEXEC | creation, kMode);
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category());
    if (IsPcapng(path)) {
      AppendPcapngHead(pending_);
      return;
    }
    cookie_io_functions_t functions{};
    functions.write = [](void* self, const char* bytes, std::size_t size) {
      static_cast<File*>(self)->pending_.append(bytes, size);
      return static_cast<ssize_t>(size);
    };
    std::FILE* const stream = fopencookie(this, "wb", functions);
    KINESCOPE_CHECK(stream != nullptr);
    std::setvbuf(stream, nullptr, _IONBF, 0);
    dead_ =
        pcap_open_dead_with_tstamp_precision(DLT_RAW, kLongestPacket, PCAP_TSTAMP_PRECISION_NANO);
    KINESCOPE_CHECK(dead_ != nullptr);
    dumper_ = pcap_dump_fopen(dead_, stream);
    KINESCOPE_CHECK(dumper_ != nullptr);
  }

  ~File() {
    if (dumper_ != nullptr) pcap_dump_close(dumper_);
    if (dead_ != nullptr) pcap_close(dead_);
    if (descriptor_ >= 0) close(descriptor_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  // Of a packet, at most.
  std::size_t SizeOf(const std::string& packet, const std::vector<std::string>& comments) const {
    constexpr std::size_t kAroundPcap = 16, kAroundPcapng = 40, kAroundComment = 8;
    if (dumper_ != nullptr) return kAroundPcap + packet.size();
    std::size_t size = kAroundPcapng + packet.size();
    for (const std::string& comment : comments) size += kAroundComment + comment.size();
    return size;
  }

  std::uint64_t bytes() const { return bytes_ + pending_.size(); }
  std::uint64_t packets() const { return packets_ + ends_.size(); }
  std::uint64_t kept_bytes() const { return bytes_; }
  std::uint64_t kept_packets() const { return packets_; }

  void Add(std::int64_t nanos, const std::string& packet,
           const std::vector<std::string>& comments) {
    if (dumper_ == nullptr) {
      AppendPcapngPacket(nanos, packet, comments, pending_);
    } else {
      pcap_pkthdr header{};
      header.ts.tv_sec = nanos / kNanosPerSecond;
      header.ts.tv_usec = nanos % kNanosPerSecond;  // nanoseconds in this format
      header.caplen = header.len = static_cast<bpf_u_int32>(packet.size());
      pcap_dump(reinterpret_cast<unsigned char*>(dumper_), &header,
                reinterpret_cast<const unsigned char*>(packet.data()));
    }
    ends_.push_back(pending_.size());
    if (pending_.size() >= kFlushBytes) Flush();
  }

  /// @throws std::system_error after truncating the file to its last complete packet.
  void Flush() {
    std::size_t written = 0;
    int error = 0;
    while (written < pending_.size() && error == 0) {
      const ssize_t count =
          write(descriptor_, pending_.data() + written, pending_.size() - written);
      if (count >= 0) written += static_cast<std::size_t>(count);
      if (count < 0 && errno != EINTR) error = errno;
    }
    if (error == 0) {
      bytes_ += pending_.size();
      packets_ += ends_.size();
    } else {
      const auto whole = std::upper_bound(ends_.begin(), ends_.end(), written);
      packets_ += static_cast<std::uint64_t>(whole - ends_.begin());
      if (whole != ends_.begin()) bytes_ += *std::prev(whole);
      // The part of the next packet that the kernel accepted would look like damage.
      if (!is_special_ && ftruncate(descriptor_, static_cast<off_t>(bytes_)) != 0) error = errno;
    }
    pending_.clear();
    ends_.clear();
    if (error != 0) throw std::system_error(error, std::generic_category());
  }

  void AddAtEnd(std::int64_t nanos, const std::vector<std::string>& comments) {
    if (dumper_ == nullptr && descriptor_ >= 0) AppendPcapngEnd(nanos, comments, pending_);
  }

  /// Some file systems report a full disk only here. @throws std::system_error
  void Close() {
    if (descriptor_ < 0) return;
    Flush();
    const bool is_safe = is_special_ || fsync(descriptor_) == 0;
    const int sync_error = errno;
    const bool is_closed = close(std::exchange(descriptor_, -1)) == 0;
    if (!is_safe) throw std::system_error(sync_error, std::generic_category());
    if (!is_closed) throw std::system_error(errno, std::generic_category());
  }

 private:
  const bool is_special_;
  int descriptor_ = -1;
  std::string pending_;            // not yet in the file
  std::vector<std::size_t> ends_;  // of the packets in pending_
  std::uint64_t bytes_ = 0;        // complete packets in the file
  std::uint64_t packets_ = 0;      // complete packets in the file
  pcap_t* dead_ = nullptr;
  pcap_dumper_t* dumper_ = nullptr;
};

PcapWriter::PcapWriter(const PcapWriterSettings& settings) : settings_(settings) { OpenFirst(); }

PcapWriter::~PcapWriter() {
  try {
    if (file_ != nullptr) file_->Close();
  } catch (const std::system_error&) {
    // Callers that need the error call Close().
  }
}

fs::path PcapWriter::PathOf(std::size_t number) const {
  if (number == 1) return settings_.path;
  std::string digits = std::to_string(number);
  digits.insert(0, digits.size() < 4 ? 4 - digits.size() : 0, '0');
  fs::path path = settings_.path;
  path.replace_filename(path.stem().string() + "-" + digits + path.extension().string());
  return path;
}

void PcapWriter::OpenFirst() {
  const fs::path& path = settings_.path;
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw SourceError(path.string() + ": is a folder; name a file in it");
  }
  if (settings_.rotate_bytes > 0) {
    for (std::size_t number = 2; fs::exists(PathOf(number), ignored); ++number) {
      if (!settings_.force) RefuseToCreate(PathOf(number), EEXIST);
      fs::remove(PathOf(number), ignored);  // of an earlier recording, not of this one
    }
  }
  try {
    file_ = std::make_unique<File>(path, settings_.force);
  } catch (const std::system_error& error) {
    RefuseToCreate(path, error.code().value());
  }
  files_.push_back(path.string());
  Flush();  // so that it is a valid capture from the beginning
}

void PcapWriter::OpenNext() {
  Try([this] { file_->Close(); });
  closed_datagrams_ += file_->kept_packets();
  closed_bytes_ += file_->kept_bytes();
  file_.reset();
  // Skips a file that another program has created since the beginning.
  std::error_code ignored;
  do {
    ++number_;
  } while (fs::exists(PathOf(number_), ignored));
  Try([this] {
    file_ = std::make_unique<File>(PathOf(number_), false);
    files_.push_back(PathOf(number_).string());
    file_->Flush();
  });
}

// Reports failures of the file as one line, with what is kept.
template <class Action>
void PcapWriter::Try(Action&& action) {
  try {
    action();
  } catch (const std::system_error& error) {
    const std::string path = PathOf(number_).string();
    if (file_ != nullptr && file_->kept_bytes() == 0) {  // not even a header, so not a capture
      std::error_code ignored;
      if (fs::is_regular_file(path, ignored)) fs::remove(path, ignored);
      if (files_.back() == path) files_.pop_back();
    }
    std::string kept = "nothing was recorded";
    if (datagrams() > 0) {
      kept = "kept and readable: " + Counted(datagrams(), "datagram") + " in " + files_.front();
      if (files_.size() > 1) kept += " to " + files_.back();
    }
    throw SourceError(path + ": recording stopped: " + std::strerror(error.code().value()) + "; " +
                      kept);
  }
}

void PcapWriter::Write(const Endpoint& from, const Endpoint& to, std::int64_t wall_nanos,
                       std::string_view datagram) {
  WriteUdpPacket(from, to, datagram, packet_);
  newest_nanos_ = std::clamp<std::int64_t>(wall_nanos, 0, kLatestNanos);
  const std::uint64_t size = file_->bytes() + file_->SizeOf(packet_, comments_);
  if (settings_.rotate_bytes > 0 && file_->packets() > 0 && size > settings_.rotate_bytes) {
    OpenNext();
  }
  Try([&] { file_->Add(newest_nanos_, packet_, comments_); });
  comments_.clear();
}

void PcapWriter::Comment(std::string text) {
  if (IsPcapng(settings_.path)) comments_.push_back(std::move(text));
}

void PcapWriter::Flush() {
  Try([this] { file_->Flush(); });
}

void PcapWriter::Close() {
  Try([this] {
    if (!comments_.empty()) file_->AddAtEnd(newest_nanos_, comments_);
    comments_.clear();
    file_->Close();
  });
}

std::uint64_t PcapWriter::datagrams() const {
  return closed_datagrams_ + (file_ != nullptr ? file_->kept_packets() : 0);
}

std::uint64_t PcapWriter::bytes() const {
  return closed_bytes_ + (file_ != nullptr ? file_->kept_bytes() : 0);
}

}  // namespace kinescope::mvn
