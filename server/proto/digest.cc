#include "server/proto/digest.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include "axisgate/v1/common.pb.h"
#include "device/core/quantity.h"

namespace axisgate::proto {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// Returns the number times 10 to the power of `digits`, or `text` unchanged if it is not a number.
std::string times_ten(const std::string& text, int digits) {
  const Result<Decimal> number = parse_decimal(text);
  if (!number) return text;
  const int left = std::max(number->decimals - digits, 0);
  std::string shifted = to_string(Decimal{number->digits, left});
  if (number->digits != 0) shifted.append(static_cast<std::size_t>(std::max(digits - number->decimals, 0)), '0');
  return shifted;
}

constexpr int kMicro = 3, kMilli = 6;  // decimal places from nanometres

void normalise(v1::Distance& distance) {
  switch (distance.amount_case()) {
    case v1::Distance::kNm:
      return distance.set_nm(times_ten(distance.nm(), 0));
    case v1::Distance::kUm:
      return distance.set_nm(times_ten(distance.um(), kMicro));
    case v1::Distance::kMm:
      return distance.set_nm(times_ten(distance.mm(), kMilli));
    case v1::Distance::kDegrees:
      return distance.set_degrees(times_ten(distance.degrees(), 0));
    case v1::Distance::kPulses:
    case v1::Distance::kFloating:
    case v1::Distance::AMOUNT_NOT_SET:
      return;
  }
}

void normalise(v1::Speed& speed) {
  switch (speed.amount_case()) {
    case v1::Speed::kNmPerS:
      return speed.set_nm_per_s(times_ten(speed.nm_per_s(), 0));
    case v1::Speed::kUmPerS:
      return speed.set_nm_per_s(times_ten(speed.um_per_s(), kMicro));
    case v1::Speed::kMmPerS:
      return speed.set_nm_per_s(times_ten(speed.mm_per_s(), kMilli));
    case v1::Speed::kDegreesPerS:
      return speed.set_degrees_per_s(times_ten(speed.degrees_per_s(), 0));
    case v1::Speed::kPulsesPerS:
    case v1::Speed::kFloating:
    case v1::Speed::AMOUNT_NOT_SET:
      return;
  }
}

void normalise(Message& message);

void normalise(Message& message, const FieldDescriptor& field) {
  const auto& reflection = *message.GetReflection();
  if (field.message_type() == v1::CallContext::descriptor()) return reflection.ClearField(&message, &field);
  if (!field.is_repeated()) return normalise(*reflection.MutableMessage(&message, &field));
  for (int i = 0; i < reflection.FieldSize(message, &field); ++i) {
    normalise(*reflection.MutableRepeatedMessage(&message, &field, i));
  }
}

void normalise(Message& message) {
  if (auto* distance = dynamic_cast<v1::Distance*>(&message)) return normalise(*distance);
  if (auto* speed = dynamic_cast<v1::Speed*>(&message)) return normalise(*speed);
  std::vector<const FieldDescriptor*> fields;
  message.GetReflection()->ListFields(message, &fields);
  for (const FieldDescriptor* field : fields) {
    if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE && !field->is_map()) normalise(message, *field);
  }
}

std::string bytes_of(const Message& message) {
  std::string bytes;
  google::protobuf::io::StringOutputStream stream(&bytes);
  google::protobuf::io::CodedOutputStream coded(&stream);
  coded.SetSerializationDeterministic(true);
  message.SerializePartialToCodedStream(&coded);
  coded.Trim();
  return bytes;
}

}  // namespace

std::string digest_of(std::string_view before, const Message& next) {
  const std::unique_ptr<Message> copy(next.New());
  copy->CopyFrom(next);
  normalise(*copy);
  const std::string bytes = std::string(before) + next.GetTypeName() + bytes_of(*copy);
  std::array<unsigned char, SHA256_DIGEST_LENGTH> hash{};
  ::SHA256(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), hash.data());
  return {hash.begin(), hash.end()};
}

std::string digest_of(const Message& request) { return digest_of({}, request); }

}  // namespace axisgate::proto
