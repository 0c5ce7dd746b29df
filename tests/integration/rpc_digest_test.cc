#include <gtest/gtest.h>

#include "axisgate/v1/stage.pb.h"
#include "server/proto/digest.h"

namespace axisgate::rpc {
namespace {

v1::MoveRequest move() {
  v1::MoveRequest request;
  request.set_device("devices/stage");
  request.mutable_context()->set_request_id("align-17");
  v1::AxisTarget& target = *request.add_targets();
  target.set_axis("1");
  target.mutable_distance()->set_um("1");
  target.mutable_profile()->mutable_maximum()->set_mm_per_s("0.05");
  return request;
}

TEST(DigestTest, TheSameAmountIsTheSameRequest) {
  v1::MoveRequest other = move();
  for (const char* nanometres : {"1000", "1000.0", "+1000"}) {
    other.mutable_targets(0)->mutable_distance()->set_nm(nanometres);
    EXPECT_EQ(proto::digest_of(other), proto::digest_of(move())) << nanometres;
  }
  other.mutable_targets(0)->mutable_distance()->set_mm("0.001");
  other.mutable_targets(0)->mutable_profile()->mutable_maximum()->set_um_per_s("50");
  EXPECT_EQ(proto::digest_of(other), proto::digest_of(move()));
}

TEST(DigestTest, TheContextIsNoPartOfIt) {
  v1::MoveRequest other = move();
  other.mutable_context()->set_device_epoch(7);
  other.mutable_context()->set_lease_token("another");
  EXPECT_EQ(proto::digest_of(other), proto::digest_of(move()));
}

TEST(DigestTest, AnythingElseIs) {
  v1::MoveRequest other = move();
  other.set_relative(true);
  EXPECT_NE(proto::digest_of(other), proto::digest_of(move()));
  other = move();
  other.mutable_targets(0)->mutable_distance()->set_um("10");
  EXPECT_NE(proto::digest_of(other), proto::digest_of(move()));
  other.mutable_targets(0)->mutable_distance()->set_pulses(1);
  EXPECT_NE(proto::digest_of(other), proto::digest_of(move())) << "pulses are not converted: the resolution may change";
  other.mutable_targets(0)->mutable_distance()->set_degrees("1");
  EXPECT_NE(proto::digest_of(other), proto::digest_of(move()));
}

TEST(DigestTest, OfAStreamTheOrderCounts) {
  const v1::MoveRequest one = move();
  v1::MoveRequest other = move();
  other.set_relative(true);
  EXPECT_NE(proto::digest_of(proto::digest_of(one), other), proto::digest_of(proto::digest_of(other), one));
}

}  // namespace
}  // namespace axisgate::rpc
