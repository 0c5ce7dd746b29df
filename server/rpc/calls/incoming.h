// A message that a stream reads, and whether one came that cannot be read.
#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/unknown_field_set.h>

namespace axisgate::rpc {

// gRPC 1.51 ends the reading of a stream alike for a client that has sent all and for a message that cannot be parsed.
// Only in the second case did it parse, and parsing clears the message first. So a mark in the message remains in the
// first case only. One read is outstanding at most.
template <class Message>
class Incoming {
 public:
  // For StartRead().
  Message* marked() {
    message_.Clear();
    message_.GetReflection()->MutableUnknownFields(&message_)->AddVarint(kMark, kMark);
    return &message_;
  }
  // After a read that has failed: a message came, and cannot be read.
  bool unreadable() const {
    const auto& fields = message_.GetReflection()->GetUnknownFields(message_);
    return fields.field_count() != 1 || fields.field(0).number() != kMark;
  }
  // After a read that has not.
  const Message& operator*() const { return message_; }
  const Message* operator->() const { return &message_; }

 private:
  static constexpr int kMark = 536'870'911;  // the highest number of a field, which proto/ does not use

  Message message_;
};

}  // namespace axisgate::rpc
