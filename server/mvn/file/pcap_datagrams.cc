#include "server/mvn/file/pcap_datagrams.h"

#include <pcap/pcap.h>
#include <spdlog/spdlog.h>

#include <array>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "server/mvn/net/net_url.h"

namespace kinescope::mvn {
namespace {

constexpr std::int64_t kLatestSecond = 0xFFFFFFFF;  // limit of the classic format: 2106

constexpr const char* kWayOut = "; record or copy it again (for details run `capinfos FILE`)";

class CountingSink : public DatagramSink {
 public:
  CountingSink(DatagramSink& next, std::uint64_t& count) : next_(next), count_(count) {}
  void OnDatagram(const ReceivedDatagram& datagram) override {
    ++count_;
    next_.OnDatagram(datagram);
  }

 private:
  DatagramSink& next_;
  std::uint64_t& count_;
};

}  // namespace

void PcapDatagrams::ClosePcap::operator()(pcap* handle) const { pcap_close(handle); }

PcapDatagrams::PcapDatagrams(InputFile file, std::string name)
    : name_(std::move(name)), file_(std::move(file)) {
  std::array<char, PCAP_ERRBUF_SIZE> error{};
  pcap_.reset(pcap_fopen_offline_with_tstamp_precision(file_.get(), PCAP_TSTAMP_PRECISION_NANO,
                                                       error.data()));
  if (pcap_ == nullptr) {
    const std::string broken = file_.failure();
    throw SourceError(name_ + ": not a readable capture file: " +
                      (broken.empty() ? error.data() : broken) + kWayOut);
  }
  file_.release();  // pcap_close() closes it
  link_type_ = pcap_datalink(pcap_.get());
  if (!KnowsLinkType(link_type_)) {
    const char* const type = pcap_datalink_val_to_name(link_type_);
    throw SourceError(name_ + ": unsupported link type " +
                      (type != nullptr ? type : std::to_string(link_type_)) +
                      "; expected Ethernet, Linux cooked (tcpdump -i any), raw IP or loopback");
  }
  mvn_ports_.set(kDefaultPort);
}

void PcapDatagrams::Break(const std::string& reason) const {
  throw SourceError(name_ + ": the capture is truncated after " + std::to_string(packets_) +
                    " packets: " + reason + kWayOut);
}

DatagramSource::State PcapDatagrams::Poll(std::chrono::nanoseconds /*timeout*/,
                                          DatagramSink& sink) {
  if (ended_) return State::kEnded;
  CountingSink counting(sink, datagrams_);
  pcap_pkthdr* header = nullptr;
  const unsigned char* bytes = nullptr;
  const int status = pcap_next_ex(pcap_.get(), &header, &bytes);
  if (status == 1) {
    ++packets_;
    AdvanceTo(*header);
    Take({reinterpret_cast<const char*>(bytes), header->caplen}, counting);
    return State::kMore;
  }
  std::FILE* const file = pcap_file(pcap_.get());
  if (status == PCAP_ERROR) {
    if (std::ferror(file) != 0) Break(file_.failure());
    if (std::feof(file) == 0) Break(pcap_geterr(pcap_.get()));
    spdlog::warn(
        "{}: the last packet is incomplete (the recorder was probably killed); {} complete packets "
        "were read",
        name_, packets_);
  }
  Finish(counting);
  return State::kEnded;
}

void PcapDatagrams::Finish(DatagramSink& sink) {
  ended_ = true;
  tcp_.End({newest_nanos_, newest_nanos_}, sink);
  fragments_.Clear();
  if (datagrams_ > 0) return;
  const char* const hint =
      cut_packets_ > 0 ? "many are truncated; capture complete packets (tcpdump -s 0)"
                       : "check that it was captured at the address and port that MVN sends to";
  spdlog::warn("{}: {} packets, but no MVN datagram; {}", name_, packets_, hint);
}

void PcapDatagrams::AdvanceTo(const pcap_pkthdr& header) {
  const std::int64_t seconds = header.ts.tv_sec;
  const std::int64_t nanos = header.ts.tv_usec;  // nanoseconds, as requested
  if (seconds < 0 || seconds > kLatestSecond || nanos < 0 || nanos >= kNanosPerSecond) return;
  const std::int64_t captured = seconds * kNanosPerSecond + nanos;
  if (!std::exchange(has_time_, true)) newest_nanos_ = captured;
  // The time, which continues after steps back, must not exceed its type either.
  if (captured > kLatestSecond * kNanosPerSecond - offset_nanos_) return;
  const std::int64_t arrival = captured + offset_nanos_;
  const std::int64_t back = newest_nanos_ - arrival;
  if (back >= kNanosPerSecond) offset_nanos_ += back;
  if (back < 0) newest_nanos_ = arrival;
}

void PcapDatagrams::Count(PacketFault fault) {
  ++(fault == PacketFault::kCutShort ? cut_packets_ : other_packets_);
}

void PcapDatagrams::Take(std::string_view captured, DatagramSink& sink) {
  const auto ip = FindIp(link_type_, captured);
  if (!ip) return Count(ip.error());
  auto packet = ParseIp(*ip);
  if (!packet) return Count(packet.error());
  if (packet->protocol != kProtocolUdp && packet->protocol != kProtocolTcp)
    return Count(PacketFault::kOther);
  if (!packet->fragment.IsWhole()) {
    const auto whole = fragments_.Add(*packet, newest_nanos_);
    if (!whole) return;
    *packet = *whole;
  }
  packet->protocol == kProtocolUdp ? TakeUdp(*packet, sink) : TakeTcp(*packet, sink);
}

void PcapDatagrams::TakeUdp(const IpPacket& packet, DatagramSink& sink) {
  const auto udp = ParseUdp(packet);
  if (!udp) return Count(udp.error());
  if (StartsWith(udp->payload, "MXTP")) mvn_ports_.set(udp->to.port);
  if (!mvn_ports_.test(udp->to.port)) return Count(PacketFault::kOther);
  sink.OnDatagram({udp->from, udp->to, udp->payload, {newest_nanos_, newest_nanos_}});
}

void PcapDatagrams::TakeTcp(const IpPacket& packet, DatagramSink& sink) {
  const auto segment = ParseTcp(packet);
  if (!segment) return Count(segment.error());
  if (!tcp_.Add(*segment, {newest_nanos_, newest_nanos_}, sink)) Count(PacketFault::kOther);
}

TransportCounters PcapDatagrams::counters() const {
  TransportCounters counters;
  counters.connections = tcp_.connections();
  counters.resyncs = tcp_.resyncs();
  counters.skipped_bytes = tcp_.skipped_bytes();
  counters.other_packets = other_packets_;
  counters.incomplete_packets = cut_packets_ + fragments_.lost() + tcp_.gaps();
  return counters;
}

}  // namespace kinescope::mvn
