// The message that a stream reads, with detection of messages that cannot be parsed.
#pragma once

#include <google/protobuf/message.h>
#include <google/protobuf/unknown_field_set.h>

namespace axisgate::rpc {

// gRPC 1.51 ends the reading of a stream in the same way after the last message and after a message that cannot be
// parsed. Parsing clears the message first, so a mark in the message stays only if the client has sent everything. At
// most one read may be outstanding.
template <class Message>
class Incoming {
 public:
  // Returns the message with the mark, for StartRead().
  Message* marked() {
    message_.Clear();
    message_.GetReflection()->MutableUnknownFields(&message_)->AddVarint(kMark, kMark);
    return &message_;
  }
  // Reports, after a read that failed, whether a message arrived that cannot be parsed.
  bool unreadable() const {
    const auto& fields = message_.GetReflection()->GetUnknownFields(message_);
    return fields.field_count() != 1 || fields.field(0).number() != kMark;
  }
  // Valid after a read that succeeded.
  const Message& operator*() const { return message_; }
  const Message* operator->() const { return &message_; }

 private:
  static constexpr int kMark = 536'870'911;  // the highest field number, which proto/ does not use

  Message message_;
};

}  // namespace axisgate::rpc
