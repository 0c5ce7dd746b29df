// What the metrics page answers to a request.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/metrics/page_request.h"

namespace axisgate::server {

// One for all its readers.
using PageText = std::shared_ptr<const std::string>;
using TakePageText = std::function<PageText()>;

struct PageAnswer {
  std::string head;
  PageText body;            // null to HEAD
  bool keep_alive = false;  // the connection stays open afterwards
};

// Takes the text only where the answer needs it.
PageAnswer answer(const PageRequest& request, const TakePageText& take_text);

// To what is not HTTP.
PageAnswer answer_malformed();

// To a head that is longer than allowed.
PageAnswer answer_too_long();

}  // namespace axisgate::server
