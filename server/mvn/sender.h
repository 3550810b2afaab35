/// Sends samples as an MVN suit would: datagrams of types 12, 13, 02, 20, 21, 22, 24 over UDP.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "server/core/body_sample.h"

namespace kinescope::mvn {

class Sender {
 public:
  virtual ~Sender() = default;
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  /// Types 12 and 13; a receiver that starts later needs them again.
  virtual void SendCharacter(const Character& character) = 0;
  /// 02; 20 where the sample has angles; 21 and 22 where it has derivatives; 24 where it has a CoM.
  virtual void SendSample(const BodySample& sample) = 0;
  virtual std::uint64_t datagrams_sent() const = 0;

 protected:
  Sender() = default;
};

/// `url` as "udp://127.0.0.1:9763". @throws SourceError naming what is wrong with it.
std::unique_ptr<Sender> OpenUdpSender(const std::string& url);

}  // namespace kinescope::mvn
