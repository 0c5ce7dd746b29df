// Answers of the metrics page to requests.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/metrics/page_request.h"

namespace axisgate::server {

// One text, shared by all readers.
using PageText = std::shared_ptr<const std::string>;
using TakePageText = std::function<PageText()>;

struct PageAnswer {
  std::string head;
  PageText body;            // null for HEAD
  bool keep_alive = false;  // the connection stays open after the answer
};

// Calls `take_text` only if the answer needs the text.
PageAnswer answer(const PageRequest& request, const TakePageText& take_text);

// Returns the answer to a request that is not HTTP.
PageAnswer answer_malformed();

// Returns the answer to a head that is longer than allowed.
PageAnswer answer_too_long();

}  // namespace axisgate::server
