/// Questions to the ROS master, and to nodes, that end in time. roscpp's own calls wait for ever
/// when something takes the connection and never answers, so whatever we ask ourselves is asked
/// here.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <chrono>
#include <optional>
#include <string>

namespace kinescope::ros_bridge {

inline constexpr std::chrono::seconds kAskMasterEvery{1};  // whether it still knows us
inline constexpr std::chrono::seconds kMasterPatience{
    3};  // a busy machine's master may take a second to answer

struct MasterReply {
  enum class Code {
    kNoAnswer,  // nothing listens there, or it did not answer in time
    kRefused,   // the master says no: an unknown node, a parameter that is not set
    kGood,
  };
  Code code = Code::kNoAnswer;
  XmlRpc::XmlRpcValue value;  // what was asked for, when good
};

/// What a master thinks of us.
enum class Standing {
  kNoAnswer,
  kUnknown,    // it has never heard of us, or has been restarted
  kKnown,      // our name is ours
  kNameTaken,  // another node has our name now
};

/// One thread uses one. Every call makes its own connection: one kept from before would belong to a
/// master that has been restarted since.
class MasterClient {
 public:
  /// @pre ros::init was called: it says where the master is and what we are called.
  MasterClient();
  /// A node's own server, such as ours: it wraps its answers as the master does.
  MasterClient(std::string host, int port);

  /// Calls `method` with our name and `arguments`, an array. Takes at most about `timeout`; a name
  /// server that does not answer can make it longer.
  MasterReply Call(const char* method, const XmlRpc::XmlRpcValue& arguments,
                   std::chrono::milliseconds timeout = std::chrono::seconds(1));

  /// Whether it knows us: that finds a master restarted under the same process number, as in a
  /// container, and one that `rosnode cleanup` made forget us.
  /// `our_uri`: of our own server; "" before there is one.
  Standing AskStanding(const std::string& our_uri, std::chrono::milliseconds timeout);

  /// Its process number; 0 from one that does not tell, nullopt without an answer.
  std::optional<int> AskPid(std::chrono::milliseconds timeout);

 private:
  std::string host_;
  int port_ = 0;
};

}  // namespace kinescope::ros_bridge
