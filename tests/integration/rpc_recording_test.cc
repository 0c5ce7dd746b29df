// The streams of DiagnosticsService.
#include <gmock/gmock.h>

#include <string>

#include "tests/integration/rpc_fixture.h"

namespace axisgate::rpc {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class RecordingTest : public RpcTest {
 protected:
  grpc::Status record(const std::string& device, std::string* text) {
    grpc::ClientContext context;
    limit(context);
    v1::RecordRequest request;
    request.set_device(device);
    const auto stream = diagnostics_->Record(&context, request);
    v1::RecordResponse response;
    while (stream->Read(&response)) *text += response.text();
    return stream->Finish();
  }
};

TEST_F(RecordingTest, EndsWithTheNewestLineWhenItIsNotToFollow) {
  std::string text;
  ASSERT_TRUE(record("devices/stage", &text).ok());
  EXPECT_THAT(text, StartsWith("# axisgate recording 1\n"));
  EXPECT_THAT(text, HasSubstr("*IDN?"));
  EXPECT_EQ(reason(record("devices/nowhere", &text)), v1::REASON_UNKNOWN_DEVICE);
}

TEST_F(RecordingTest, AReaderThatDoesNotReadHoldsNoMotionUpAndGetsAllLater) {
  grpc::ClientContext context;
  limit(context);
  v1::RecordRequest request;
  request.set_device("devices/stage");
  request.set_skip_kept(true);
  request.set_follow(true);
  const auto stream = diagnostics_->Record(&context, request);
  stream->WaitForInitialMetadata();
  v1::RecordResponse response;
  ASSERT_TRUE(stream->Read(&response));
  EXPECT_THAT(response.text(), StartsWith("# axisgate recording 1\n"));
  for (int i = 0; i < 20; ++i) {
    v1::Motion motion;
    ASSERT_TRUE(move(move_request(1, i % 2 == 0 ? "0.1" : "0"), &motion).ok());
    ASSERT_EQ(outcome(motion.name()).state(), v1::MOTION_STATE_SUCCEEDED);
  }
  int completions = 0;
  while (completions < 20) {
    ASSERT_TRUE(stream->Read(&response)) << completions;
    EXPECT_THAT(response.text(), Not(HasSubstr("lines lost")));
    for (std::size_t at = response.text().find(" completion 1"); at != std::string::npos;
         at = response.text().find(" completion 1", at + 1)) {
      ++completions;
    }
  }
  context.TryCancel();
}

TEST_F(RecordingTest, ASupportReportIsOneTextOfSections) {
  grpc::ClientContext context;
  limit(context);
  const auto stream = diagnostics_->GetSupportReport(&context, v1::GetSupportReportRequest());
  v1::GetSupportReportResponse response;
  std::string text;
  while (stream->Read(&response)) text += response.text();
  EXPECT_TRUE(stream->Finish().ok());
  EXPECT_THAT(text, HasSubstr("\n== recording of stage ==\n# axisgate recording 1\n"));
  EXPECT_THAT(text, HasSubstr("\n== replaced ==\n1 serial number, "));
}

}  // namespace
}  // namespace axisgate::rpc
