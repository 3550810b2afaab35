/// Reads MVN datagrams from a capture (pcap, pcapng) of tcpdump, Wireshark or `kinescope record`:
/// UDP, also in IP fragments, and TCP, put in order. One thread.
///
/// - UDP packets count if they begin with "MXTP", or go to MVN's port or to a port that received
///   "MXTP": sync text is part of the stream, a DNS query is not.
/// - The receive time is the time of capture, on both clocks, of the packet that completed the
///   datagram. It never goes back. If the time in the file goes back by less than a second (packets
///   written out of order), it stands still; if by more (the clock was set), it continues from
///   there.
/// - A capture that ends inside a packet (its writer was killed) ends there, with a warning.
#pragma once

#include <bitset>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "core/system/input_file.h"
#include "server/mvn/datagram_source.h"
#include "server/mvn/file/captured_tcp.h"
#include "server/mvn/file/ip_fragments.h"

struct pcap;         // of libpcap
struct pcap_pkthdr;  // of libpcap

namespace kinescope::mvn {

class PcapDatagrams : public DatagramSource {
 public:
  /// Reads the header of the file; `name` is for messages.
  /// @throws SourceError: not a capture, or a network type without IP packets.
  PcapDatagrams(InputFile file, std::string name);

  /// Delivers the datagrams that one packet completes. @throws SourceError if the file is damaged.
  [[nodiscard]] State Poll(std::chrono::nanoseconds timeout, DatagramSink& sink) override;

  TransportCounters counters() const override;
  std::string description() const override { return name_; }
  bool is_live() const override { return false; }

 private:
  struct ClosePcap {
    void operator()(pcap* handle) const;
  };

  void Take(std::string_view captured, DatagramSink& sink);
  void TakeUdp(const IpPacket& packet, DatagramSink& sink);
  void TakeTcp(const IpPacket& packet, DatagramSink& sink);
  void Count(PacketFault fault);
  void AdvanceTo(const pcap_pkthdr& header);
  void Finish(DatagramSink& sink);
  [[noreturn]] void Break(const std::string& reason) const;

  std::string name_;
  InputFile file_;  // gives the reason when reading fails; libpcap reads and closes it
  std::unique_ptr<pcap, ClosePcap> pcap_;
  int link_type_ = 0;
  bool ended_ = false;

  std::uint64_t packets_ = 0;
  std::uint64_t other_packets_ = 0;
  std::uint64_t cut_packets_ = 0;
  std::uint64_t datagrams_ = 0;
  std::bitset<65536> mvn_ports_;
  IpFragments fragments_;
  CapturedTcp tcp_;

  bool has_time_ = false;
  std::int64_t newest_nanos_ = 0;  // arrival of the newest packet
  std::int64_t offset_nanos_ = 0;  // receive time minus time in the file
};

}  // namespace kinescope::mvn
