/// The MVN stream from a UDP socket. One thread.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/core/source.h"
#include "server/mvn/arrival.h"
#include "server/mvn/assembler.h"
#include "server/mvn/udp_url.h"

namespace kinescope::mvn {

class UdpSource : public Source {
 public:
  /// Listens at once. @throws SourceError (see OpenUdp).
  explicit UdpSource(const std::string& url);
  ~UdpSource() override;

  State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;
  /// Datagrams that the kernel dropped because nobody read them in time are added as a `rejected`
  /// reason of their own; they are not among `datagrams`.
  SourceCounters counters() const override;
  std::string description() const override { return description_; }  // with the real port
  bool is_live() const override { return true; }

  std::uint16_t port() const { return port_; }
  /// What the kernel really gave to this socket, its own book-keeping included.
  int receive_buffer_bytes() const { return receive_buffer_bytes_; }
  std::uint64_t kernel_drops() const { return kernel_drops_; }

 private:
  struct Batch;

  void Configure();
  void Bind(const UdpUrl& url, const std::string& text);
  bool WaitForInput(std::chrono::milliseconds timeout);
  int ReadBatch(SampleSink& sink);
  Arrival Inspect(const void* message_header, const Arrival& now);

  Socket socket_;
  std::string description_;
  std::uint16_t port_ = 0;
  int receive_buffer_bytes_ = 0;
  std::uint64_t kernel_drops_ = 0;
  std::uint32_t last_overflow_ = 0;  // the kernel's own count, which wraps
  std::unique_ptr<Batch> batch_;
  Assembler assembler_;
};

}  // namespace kinescope::mvn
