/// The description of the routes in the form of OpenAPI 3.1, docs/openapi.json.
#pragma once

namespace kinescope::http {

/// The whole file. A test compares it with the routes of the router (openapi_test.cc).
extern const char* const kOpenApi;

}  // namespace kinescope::http
