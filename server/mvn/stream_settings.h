/// Defines how the datagrams of a stream become samples.
#pragma once

namespace kinescope::mvn {

/// Which clock gives BodySample::stamp_nanos (option --stamps).
enum class Stamps {
  kFitted,   // receive time, smoothed along the sender's clock (clock_fit.h)
  kArrival,  // receive time, unchanged
};

/// How long an incomplete sample waits for its other datagrams, unless newer samples show earlier
/// that they are lost.
enum class Delivery {
  kPrompt,    // 1.5 periods of the stream, 5 to 100 ms: for people and robots that follow it
  kComplete,  // 1 s: for files, which lose a message if sender or receiver pause within a sample
};

struct StreamSettings {
  Stamps stamps = Stamps::kFitted;
  Delivery delivery = Delivery::kComplete;
};

}  // namespace kinescope::mvn
