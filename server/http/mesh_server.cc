#include "server/http/mesh_server.h"

#include <iterator>

#include "server/http/server.h"
#include "server/http/target.h"

namespace kinescope::http {

MeshServer::MeshServer()
    : server_(Listener::OpenToAll(), [this](const Request& request) { return Route(request); }),
      thread_([this] { server_.Serve([this] { return stopping_.load(); }); }) {}

MeshServer::~MeshServer() {
  stopping_ = true;
  thread_.join();
}

void MeshServer::Offer(const std::string& set, const std::shared_ptr<const MeshFiles>& files) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto known = sets_.begin(); known != sets_.end();) {
    const bool is_over = known->second.expired() || known->second.lock() == files;
    known = is_over ? sets_.erase(known) : std::next(known);
  }
  sets_.emplace(set, files);
}

std::shared_ptr<const MeshFiles> MeshServer::Find(const std::string& set) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto [first, last] = sets_.equal_range(set);
  for (auto found = first; found != last; ++found) {
    if (auto files = found->second.lock()) return files;
  }
  return nullptr;
}

Answer MeshServer::Route(const Request& request) {
  if (request.method != "GET" && request.method != "HEAD") {
    Answer answer = ErrorAnswer(405, "unknown method; expected GET or HEAD");
    answer.headers.emplace_back("Allow", "GET, HEAD");
    return answer;
  }
  const auto target = ParseTarget(request.target);
  if (!target) return ErrorAnswer(400, target.error());
  const std::string& path = target->path;  // "/set/file"
  const std::size_t slash = path.rfind('/');
  const auto files = slash == 0 ? nullptr : Find(path.substr(1, slash - 1));
  const auto content = files ? files->Content(path.substr(slash + 1)) : nullptr;
  if (!content) {
    return ErrorAnswer(404, "no such mesh; the URDF on the ROS master names those that exist");
  }
  Answer answer;
  answer.content_type = "model/stl";
  answer.body = *content;
  return answer;
}

}  // namespace kinescope::http
