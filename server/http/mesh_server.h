/// Serves the meshes of published URDFs to other computers, such as the one on which RViz runs: GET
/// of http://<this computer>:<port>/<set>/<file>. It listens on all addresses at a free port, as
/// every ROS node does, and asks for no token: the URDF that names the meshes, and the motion, are
/// as open. Nothing but these files can be read, and nothing can be changed. Its own thread.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/mesh_files.h"
#include "server/http/plain_server.h"

namespace kinescope::http {

class MeshServer {
 public:
  /// Listens. @throws UsageError with the reason.
  MeshServer();
  ~MeshServer();
  MeshServer(const MeshServer&) = delete;
  MeshServer& operator=(const MeshServer&) = delete;

  int port() const { return server_.port(); }

  /// Serves `files` as the set called `set`, while they exist. Never blocks; any thread.
  void Offer(const std::string& set, const std::shared_ptr<const MeshFiles>& files);

 private:
  Answer Route(const Request& request);
  std::shared_ptr<const MeshFiles> Find(const std::string& set);

  std::mutex mutex_;
  // Guarded by mutex_. Equal sets of several people have one name.
  std::multimap<std::string, std::weak_ptr<const MeshFiles>> sets_;
  std::atomic<bool> stopping_{false};
  PlainServer server_;
  std::thread thread_;  // last: it uses all other members
};

}  // namespace kinescope::http
