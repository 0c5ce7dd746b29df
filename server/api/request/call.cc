#include "server/api/request/call.h"

#include "server/access/access.h"
#include "server/access/tokens.h"

namespace axisgate::api {

std::string name_of(const Credential& credential) {
  return credential.token ? server::token_caller(server::name_in(*credential.token)) : credential.who;
}

}  // namespace axisgate::api
