/// Alarms and their rules as JSON (docs/http.md). Any thread.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "server/alarms/alarms.h"

namespace kinescope::alarms {

nlohmann::json ToJson(const Alarm& alarm);
nlohmann::json ToJson(const Rule& rule);

/// What the page shows of alarms: those that are on or wait for being acknowledged. Equal alarms
/// give equal text.
std::string ShownJson(const Alarms& alarms);

/// What a webhook is told of a change.
std::string NewsJson(const Alarm& alarm, Change change);

/// Rules, and alarms of the past.
std::string LogJson(const Alarms& alarms);

}  // namespace kinescope::alarms
