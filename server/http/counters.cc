#include "server/http/counters.h"

#include <nlohmann/json.hpp>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

json CounterJson(const ClientCounters& client) {
  return {{"id", client.id},
          {"pictures", client.pictures},
          {"states_sent", client.states_sent},
          {"states_dropped", client.states_dropped},
          {"pictures_sent", client.pictures_sent},
          {"pictures_dropped", client.pictures_dropped}};
}

json TlsJson(const TlsStatus& tls) {
  return {{"names", tls.names},
          {"valid_until", tls.valid_until},
          {"reloads", tls.reloads},
          {"failed_reloads", tls.failed_reloads},
          {"last_error", tls.last_error}};
}

}  // namespace

std::string WithHttpCounters(const std::string& diagnostics, const Counters& counters,
                             const std::vector<ClientCounters>& clients, const TlsStatus* tls) {
  json document = ParseJson(diagnostics);
  if (!document.is_object()) document = {{"error", "internal error: the diagnostics are not JSON"}};
  json connected = json::array();
  for (const ClientCounters& client : clients) connected.push_back(CounterJson(client));
  json closed = CounterJson(counters.closed);
  closed.erase("id");
  closed.erase("pictures");
  document["http"] = {{"requests", counters.requests},
                      {"snapshots", counters.snapshots},
                      {"rejected", counters.rejected},
                      {"failures", counters.failures},
                      {"websockets_opened", counters.opened},
                      {"states_encoded", counters.states_encoded},
                      {"past_states_encoded", counters.past_states_encoded},
                      {"pictures_encoded", counters.pictures_encoded},
                      {"clients", std::move(connected)},
                      {"closed_clients", std::move(closed)}};
  document["http"]["tls"] = tls != nullptr ? TlsJson(*tls) : json(nullptr);
  return JsonText(document, 2);
}

}  // namespace kinescope::http
