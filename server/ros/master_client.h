/// Calls the ROS master and nodes with a time limit. roscpp's own calls wait without limit if a
/// connection is accepted and never answered, so Kinescope makes its own calls here.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace XmlRpc {
class XmlRpcClient;
}

namespace kinescope::ros_bridge {

inline constexpr std::chrono::seconds kAskMasterEvery{1};  // interval of the registration check
// The master of a busy machine may take a second to answer, and so does a packet that was lost.
inline constexpr std::chrono::seconds kMasterPatience{3};

/// Of all calls together while the program ends.
inline constexpr std::chrono::milliseconds kLastPatience{1500};

struct MasterReply {
  enum class Code {
    kNoAnswer,  // not reachable, or no answer in time
    kRefused,   // the master reports an error: an unknown node, a parameter that is not set
    kGood,
  };
  Code code = Code::kNoAnswer;
  bool is_late = false;       // kNoAnswer because the time was over
  XmlRpc::XmlRpcValue value;  // the result, for kGood
  std::string problem;        // why an answer was rejected (xmlrpc_limits.h); "": it was not
};

/// Registration state of this node at the master.
enum class RegistrationState {
  kNoAnswer,
  kUnknown,    // never registered there, or the master was restarted
  kKnown,      // registered under this name
  kNameTaken,  // another node has this node's name
};

enum class Connection {
  kNew,   // for every call: a kept one could belong to a master that has been restarted since
  kKept,  // while calls succeed
};

/// Used by one thread.
class MasterClient {
 public:
  /// @pre ros::init was called: it defines the master's address and this node's name.
  MasterClient();
  /// For the server of a node, such as this one: its answers have the form of the master's.
  MasterClient(std::string host, int port, Connection connection = Connection::kNew);
  ~MasterClient();
  MasterClient(const MasterClient&) = delete;
  MasterClient& operator=(const MasterClient&) = delete;

  /// Calls `method` with this node's name and `arguments`, an array. Takes at most about `timeout`;
  /// a name server that does not answer can make it longer.
  MasterReply Call(const char* method, const XmlRpc::XmlRpcValue& arguments,
                   std::chrono::milliseconds timeout = kMasterPatience);

  /// Sets a parameter; false if the master does not accept it. Private names are this node's.
  bool SetParameter(const std::string& name, const XmlRpc::XmlRpcValue& value);

  /// Whether the master knows this node. It detects a master restarted under the same process id,
  /// as in a container, and one that `rosnode cleanup` made forget this node.
  /// `our_uri`: of this node's own server; "" before it exists.
  RegistrationState AskRegistration(const std::string& our_uri, std::chrono::milliseconds timeout);

  /// The process id of the master; 0 if it does not report one, nullopt without an answer.
  std::optional<int> AskPid(std::chrono::milliseconds timeout);

  /// Why the answer to the last call was rejected; "" if it was not, or there was none.
  const std::string& problem() const { return problem_; }

 private:
  std::string host_;
  int port_ = 0;
  const Connection connection_ = Connection::kNew;
  std::unique_ptr<XmlRpc::XmlRpcClient> client_;  // kKept: of the last call, if it was answered
  std::string problem_;
};

/// Where the server of a node is.
struct NodeServer {
  std::string host;
  int port = 0;
};
/// As the master knows it, whether or not the node still runs; nullopt: it does not.
std::optional<NodeServer> FindNodeServer(const std::string& node,
                                         std::chrono::milliseconds timeout = kMasterPatience);

/// Whether a node of this name runs. One that was killed stays in the master's lists.
bool DoesNodeAnswer(const std::string& node, std::chrono::milliseconds timeout = kMasterPatience);

}  // namespace kinescope::ros_bridge
