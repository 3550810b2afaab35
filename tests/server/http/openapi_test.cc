// The description of the routes, docs/openapi.json, against the routes of the router.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>

#include "server/http/open_api.h"
#include "server/http/router.h"
#include "tests/folders.h"

namespace kinescope::http::testing {
namespace {

using nlohmann::json;
using ::testing::IsEmpty;

const json& Description() {
  static const json kDescription = json::parse(kOpenApi);
  return kDescription;
}

using Operation = std::pair<std::string, std::string>;  // "GET", "/api/v1/state"

// What is described, with the role that it needs.
std::map<Operation, Role> Described() {
  std::map<Operation, Role> operations;
  for (const auto& [path, methods] : Description().at("paths").items()) {
    for (const auto& [method, operation] : methods.items()) {
      std::string name = method;
      for (char& c : name) c = static_cast<char>(c - 'a' + 'A');
      const json security = operation.value("security", Description().at("security"));
      std::set<Role> roles;
      for (const json& way : security) {
        for (const auto& [scheme, needed] : way.items()) {
          roles.insert(needed == json::array({Name(Role::kOperator)}) ? Role::kOperator
                                                                      : Role::kViewer);
          EXPECT_TRUE(Description().at("components").at("securitySchemes").contains(scheme));
        }
      }
      EXPECT_EQ(roles.size(), 1u) << path << ": whichever way the token is sent";
      operations[{name, path}] = *roles.begin();
    }
  }
  return operations;
}

void ForEachRef(const json& part, const std::function<void(const std::string&)>& found) {
  if (part.is_object() && part.contains("$ref")) found(part.at("$ref"));
  for (const json& child : part) {
    if (child.is_structured()) ForEachRef(child, found);
  }
}

TEST(OpenApi, IsTheFileOfTheDocuments) {
  std::ifstream file(kinescope::testing::InSourceTree("docs/openapi.json"));
  EXPECT_EQ(kOpenApi, std::string(std::istreambuf_iterator<char>(file), {}));
  EXPECT_EQ(Description().at("openapi"), "3.1.0");
}

TEST(OpenApi, DescribesEveryRouteWithItsRoleAndNoOther) {
  std::map<Operation, Role> routes;
  for (const Router::RouteInfo& route : Router::ApiRoutes()) {
    routes[{route.method, route.path}] = route.least;
  }
  EXPECT_EQ(Described(), routes);
}

TEST(OpenApi, HasEveryPartThatItRefersToAndUsesEveryPart) {
  std::set<std::string> used, unused;
  ForEachRef(Description(), [&](const std::string& ref) {
    ASSERT_EQ(ref.substr(0, 2), "#/") << ref;
    EXPECT_TRUE(Description().contains(json::json_pointer(ref.substr(1)))) << ref;
    used.insert(ref);
  });
  for (const char* kind : {"parameters", "responses", "schemas"}) {
    for (const auto& [name, part] : Description().at("components").at(kind).items()) {
      const std::string ref = std::string("#/components/") + kind + "/" + name;
      if (used.count(ref) == 0) unused.insert(ref);
    }
  }
  EXPECT_THAT(unused, IsEmpty());
}

TEST(OpenApi, DescribesEveryVariableOfAPathAndNamesEachOperationOnce) {
  std::set<std::string> names;
  for (const auto& [path, methods] : Description().at("paths").items()) {
    for (const auto& [method, operation] : methods.items()) {
      EXPECT_TRUE(names.insert(operation.at("operationId")).second) << operation.at("operationId");
      std::string described, variables;
      for (json parameter : operation.value("parameters", json::array())) {
        if (parameter.contains("$ref")) {
          const std::string ref = parameter.at("$ref");
          parameter = Description().at(json::json_pointer(ref.substr(1)));
        }
        if (parameter.at("in") == "path")
          described += "{" + std::string(parameter.at("name")) + "}";
      }
      for (std::size_t at = path.find('{'); at != std::string::npos; at = path.find('{', at + 1)) {
        variables += path.substr(at, path.find('}', at) - at + 1);
      }
      EXPECT_EQ(described, variables) << path;
    }
  }
}

}  // namespace
}  // namespace kinescope::http::testing
