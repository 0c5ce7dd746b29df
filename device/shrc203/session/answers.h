// Test for questions that were answered with data.
#pragma once

#include "device/shot/line/line.h"

namespace axisgate::shrc203 {

inline bool is_data(const ExchangeResult& result) {
  return result.reply && !result.problem && result.reply->kind == Reply::Kind::data;
}

}  // namespace axisgate::shrc203
