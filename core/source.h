/// Where samples come from: a socket, a file, the built-in subject. One thread uses a source.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "core/body_sample.h"

namespace kinescope {

/// What a source saw so far. Every datagram ends in exactly one place: a sample, a character, one
/// of the `rejected` reasons, `ignored`, `duplicates`, `late` or `outliers`.
struct SourceCounters {
  std::uint64_t datagrams = 0;  // all that were read
  std::uint64_t bytes = 0;
  std::uint64_t samples = 0;     // given on
  std::uint64_t incomplete = 0;  // of these, given on without a type that the stream normally has
  std::uint64_t duplicates = 0;
  std::uint64_t late = 0;          // for a sample already given on
  std::uint64_t counter_gaps = 0;  // steps of the sample counter above the usual one
  std::uint64_t restarts = 0;      // the counter started over
  std::uint64_t outliers = 0;      // a counter or a character that nothing else confirmed
  std::map<std::string, std::uint64_t> types;     // datagrams that were read, by type: "02"
  std::map<std::string, std::uint64_t> ignored;   // good, not needed: "frame of type tpose"
  std::map<std::string, std::uint64_t> rejected;  // bad, by reason: "no MXTP id string"
  /// What the transport saw, such as "receive_buffer_bytes" or "connections_open"; empty where
  /// there is none.
  std::map<std::string, std::uint64_t> transport;
};

class SampleSink {
 public:
  virtual ~SampleSink() = default;
  virtual void OnCharacter(const Character& character) = 0;
  virtual void OnSample(const BodySample& sample) = 0;
  virtual void OnObjects(const ObjectsSample&) {}
};

class Source {
 public:
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  enum class State { kMore, kEnded };

  /// Waits at most `timeout` for input and hands on what came. A live source never ends; a file
  /// gives a few samples a call, as fast as it is asked, with stamps from its own clock.
  /// @throws SourceError when it cannot go on (a file that breaks off, a socket that fails).
  [[nodiscard]] virtual State Poll(std::chrono::milliseconds timeout, SampleSink& sink) = 0;

  virtual SourceCounters counters() const = 0;
  virtual std::string description() const = 0;  // "udp://0.0.0.0:9763", for people
  virtual bool is_live() const = 0;             // samples come when they come; else: as asked for

  /// Samples a second where the source says it (a file, the subject); 0 where only arrival tells.
  virtual double nominal_rate_hz() const { return 0; }

 protected:
  Source() = default;
};

}  // namespace kinescope
