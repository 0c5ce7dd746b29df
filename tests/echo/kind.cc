#include "tests/echo/kind.h"

#include "tests/echo/model.h"

namespace axisgate::echo {
namespace {

class Echo final : public jobs::Kind {
 public:
  std::string_view name() const override { return "echo"; }
  std::shared_ptr<const jobs::Model> read_model(ConfigTable& table, std::vector<ConfigError>&) const override {
    return std::make_shared<const EchoModel>(table.text("profile").value_or("echo-1"));
  }
  Result<void> check_option(std::string_view, std::string_view) const override {
    return fail(Reason::invalid_request, "the simulated echo machine has no options", "leave them out");
  }
};

}  // namespace

const jobs::Kind& kind() {
  static const Echo kind;
  return kind;
}

}  // namespace axisgate::echo
