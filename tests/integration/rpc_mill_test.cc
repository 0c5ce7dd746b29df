// MillService with the built-in simulator: from a job's bytes to what a person says of the workpiece.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include "tests/integration/rpc_mill_fixture.h"

namespace axisgate::rpc {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(RpcMill, AConfirmedJobIsFedAndAPersonSaysDone) {
  const v1::Job job = sent(vectors(2));
  EXPECT_EQ(job.name(), "devices/mill/jobs/1");
  EXPECT_EQ(job.title(), "part.rml");
  EXPECT_EQ(job.state(), v1::JOB_STATE_QUEUED);
  EXPECT_THAT(job.owner().name(), testing::StartsWith("unix "));
  EXPECT_EQ(job.bytes(), static_cast<std::int64_t>(vectors(2).size()));
  EXPECT_THAT(job.setup().digest(), SizeIs(64));
  EXPECT_GT(job.longest_time().seconds() + job.longest_time().nanos(), 0);
  ASSERT_TRUE(confirm(job).ok());
  v1::StartJobResponse started;
  ASSERT_TRUE(start(job, &started).ok());
  EXPECT_EQ(started.job().state(), v1::JOB_STATE_RUNNING);
  EXPECT_EQ(started.run_on().at_most(), 64);
  EXPECT_GE(started.run_on().longest_time().seconds(), 1) << "of three moves of half a second";
  EXPECT_LT(started.run_on().longest_time().seconds(), 10);
  watch_until(job_is(job, v1::JOB_STATE_FED));
  v1::ReportJobDoneRequest done;
  done.set_job(job.name());
  EXPECT_TRUE(ask(&v1::MillService::Stub::ReportJobDone, done).ok());
  EXPECT_THAT(now().jobs(), IsEmpty());
}

TEST_F(RpcMill, WithoutAConfirmationItDoesNotStart) {
  const v1::Job job = sent(vectors(6));
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_CONFIRMED);
  v1::Job other = job;
  other.mutable_setup()->set_tool("T2");
  EXPECT_EQ(reason(confirm(other)), v1::REASON_SETUP_CHANGED);
}

// The worker reads no job in vain, so no other caller waits for that.
TEST_F(RpcMill, WhatCannotStartOrContinueIsNotRead) {
  const v1::Job job = sent(vectors(6));
  std::ofstream(directory_ + ".spool/mill/1.rml", std::ios::app) << "PU;";
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_CONFIRMED);
  v1::ContinueJobRequest request;
  request.set_job(job.name());
  request.set_line(1);
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::ContinueJob, request)), v1::REASON_WRONG_JOB_STATE);
  ASSERT_TRUE(confirm(job).ok());
  EXPECT_EQ(reason(start(job)), v1::REASON_INTERNAL) << "its bytes are others than they were";
}

TEST_F(RpcMill, AJobWithErrorsIsRefusedWithItsPlace) {
  const grpc::Status status = send("PA;\nPU0,0;\nPX1;\n!MC0;");
  EXPECT_EQ(reason(status), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(status.error_message(), HasSubstr("line 3"));
  EXPECT_THAT(now().jobs(), IsEmpty());
  EXPECT_EQ(reason(send(vectors(2), nullptr, "T7")), v1::REASON_INVALID_REQUEST);
}

TEST_F(RpcMill, NothingHoldsTheHostBackFromTheBuiltInSimulator) {
  const grpc::Status full = send(vectors(2), nullptr, "T1", "", v1::STREAMING_FULL);
  EXPECT_EQ(reason(full), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(full.error_message(), HasSubstr("nothing holds the host back while the buffer of mill is full"));
  EXPECT_EQ(reason(send(vectors(2), nullptr, "T1", "", static_cast<v1::Streaming>(7))), v1::REASON_INVALID_REQUEST);
  v1::Job job;
  EXPECT_TRUE(send(vectors(2), &job, "T1", "", v1::STREAMING_PACED).ok());
  EXPECT_EQ(job.streaming(), v1::STREAMING_PACED);
}

TEST_F(RpcMill, AJobIsCheckedForItsWorkpieceAndItsProfile) {
  v1::JobHeader header = header_of("");
  const auto send_with = [&](v1::Job* job = nullptr) {
    return upload(header, {"PA;VS15;!PZ-100,200;PU100,100;PD2000,100;PU0,0;!MC0;"}, job);
  };
  EXPECT_TRUE(send_with().ok());
  header.mutable_stock()->mutable_x()->set_mm("10");
  EXPECT_EQ(reason(send_with()), v1::REASON_INVALID_REQUEST) << "Y and Z are missing";
  header.mutable_stock()->mutable_y()->set_um("10000");
  for (const char* length : {"0", "-1", "10001"}) {
    header.mutable_stock()->mutable_z()->set_mm(length);
    EXPECT_THAT(send_with().error_message(), HasSubstr("the workpiece has no size")) << length;
  }
  header.mutable_stock()->mutable_z()->set_pulses(500);
  EXPECT_EQ(reason(send_with()), v1::REASON_UNKNOWN_UNIT);
  header.mutable_stock()->mutable_z()->set_mm("5");
  const grpc::Status beside = send_with();
  EXPECT_EQ(reason(beside), v1::REASON_INVALID_REQUEST) << "X reaches 50 mm";
  EXPECT_THAT(beside.error_message(), HasSubstr("warning"));
  header.mutable_stock()->mutable_x()->mutable_floating()->set_value(60);
  header.mutable_stock()->mutable_x()->mutable_floating()->set_unit(v1::UNIT_MILLIMETERS);
  v1::Job job;
  const grpc::Status within = send_with(&job);
  EXPECT_TRUE(within.ok()) << within.error_message();
  EXPECT_EQ(job.stock().x().mm(), "60");
  EXPECT_EQ(job.stock().y().mm(), "10");
  header.set_made_for("mdx-40");
  EXPECT_THAT(send_with().error_message(), HasSubstr("made-for-another-mill: line 1, column 1: made for the MDX-40"));
  header.set_made_for("mdx-400");
  EXPECT_THAT(send_with().error_message(), HasSubstr("there is no profile \"mdx-400\""));
  header.set_made_for("mdx-20");
  EXPECT_TRUE(send_with().ok());
}

// A client that repeats an upload may cut it otherwise.
TEST_F(RpcMill, ARepeatedUploadIsTheSameHoweverItIsCut) {
  v1::Job first, again;
  ASSERT_TRUE(send_in_pieces(vectors(20), 1000, "part.rml", &first).ok());
  for (const std::size_t piece : {1, 7, 100'000}) {
    const grpc::Status status = send_in_pieces(vectors(20), piece, "part.rml", &again);
    ASSERT_TRUE(status.ok()) << piece << ": " << status.error_message();
    EXPECT_EQ(again.name(), first.name()) << piece;
  }
  EXPECT_FALSE(send_in_pieces(vectors(21), 1000, "part.rml", &again).ok()) << "other bytes";
  EXPECT_FALSE(send_in_pieces(vectors(20), 1000, "lid.rml", &again).ok()) << "another title";
}

TEST_F(RpcMill, TheToolIsChangedBetweenTheParts) {
  v1::Job job, again;
  ASSERT_TRUE(send_parts({{"T1", vectors(1)}, {"T2", vectors(2)}}, &job).ok());
  ASSERT_EQ(job.parts_size(), 2);
  EXPECT_EQ(job.parts(1).tool(), "T2");
  EXPECT_EQ(job.parts(1).bytes(), static_cast<std::int64_t>(vectors(2).size()));
  EXPECT_EQ(job.setup().tool(), "T1");
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  v1::Job next = watch_until(job_is(job, v1::JOB_STATE_TOOL_CHANGE)).jobs(0);
  EXPECT_EQ(next.part(), 2);
  EXPECT_EQ(next.setup().tool(), "T2");
  EXPECT_EQ(next.setup().digest(), job.setup().digest());
  ASSERT_TRUE(send_parts({{"T1", vectors(1)}, {"T2", vectors(2)}}, &again).ok());
  EXPECT_EQ(again.name(), job.name()) << "the same request";
  EXPECT_EQ(reason(confirm(job)), v1::REASON_SETUP_CHANGED) << "T1 was seen";
  ASSERT_TRUE(confirm(next).ok());
  ASSERT_TRUE(start(next).ok());
  watch_until(job_is(job, v1::JOB_STATE_FED));
}

TEST_F(RpcMill, PartsThatDoNotFitAreRefused) {
  const std::string good = vectors(2);
  EXPECT_THAT(send_parts({{"T1", good}, {"T2", "PA;\nPX1;\n"}}).error_message(),
              HasSubstr("file 2: line 2, column 1: "));
  EXPECT_THAT(send_parts({{"T1", good}}, nullptr, -1).error_message(), HasSubstr("bytes came"));
  EXPECT_THAT(send_parts({{"T1", good}}, nullptr, 1).error_message(), HasSubstr("the job has more than the "));
  EXPECT_THAT(send_parts({{"T1", good}, {"T1", ""}}).error_message(), HasSubstr("no bytes"));
  EXPECT_THAT(send_parts({{"T1", good}, {"T7", good}}).error_message(), HasSubstr("no tool \"T7\""));
  EXPECT_EQ(reason(send_parts({{"T1", good}}, nullptr, 0, "T1")), v1::REASON_INVALID_REQUEST);
  EXPECT_EQ(reason(send_parts(Parts(17, {"T1", good}))), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(now().jobs(), IsEmpty());
}

TEST_F(RpcMill, AnAbortEndsTheJobAndVoidsTheNextConfirmation) {
  const v1::Job job = sent(vectors(2000)), second = sent(vectors(4));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  watch_until([](const v1::Mill& mill) { return mill.running().executed_least() > 20; });
  EXPECT_EQ(reason(confirm(second)), v1::REASON_WRONG_JOB_STATE);
  const grpc::Status aborted = on_mill(&v1::MillService::Stub::AbortJob);
  ASSERT_TRUE(aborted.ok()) << aborted.error_message();
  const v1::Mill mill = watch_until([](const v1::Mill& it) { return !it.has_running() && it.jobs_size() == 1; });
  EXPECT_EQ(mill.jobs(0).name(), second.name());
  ASSERT_TRUE(confirm(second).ok());
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::AbortJob).ok()) << "it always acts";
  EXPECT_EQ(reason(start(second)), v1::REASON_NOT_CONFIRMED);
}

TEST_F(RpcMill, AStopOfAnAxisIsOfTheOnlyStage) {
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  grpc::ClientContext context;
  limit(context);
  v1::StopRequest request;
  request.add_axes("1");
  v1::StopResponse response;
  ASSERT_TRUE(stage_->Stop(&context, request, &response).ok());
  ASSERT_EQ(response.devices_size(), 1);
  EXPECT_EQ(response.devices(0).device(), "devices/stage");
  EXPECT_TRUE(now().has_running());
}

TEST_F(RpcMill, ItIsAmongTheDevices) {
  grpc::ClientContext context;
  limit(context);
  v1::ListDevicesResponse there;
  ASSERT_TRUE(devices_->ListDevices(&context, v1::ListDevicesRequest(), &there).ok());
  ASSERT_EQ(there.devices_size(), 2);
  EXPECT_EQ(there.devices(0).kind(), "shrc203");
  const v1::Device& mill = there.devices(1);
  EXPECT_EQ(mill.name(), kMill);
  EXPECT_EQ(mill.kind(), "rml1");
  EXPECT_EQ(mill.link(), v1::LINK_STATE_UP);
  EXPECT_EQ(mill.link_problem(), "");
  EXPECT_EQ(mill.model(), "MDX-20");
  EXPECT_THAT(mill.axes(), IsEmpty());
}

TEST_F(RpcMill, PauseAndResume) {
  const v1::Job job = sent(vectors(6));
  EXPECT_EQ(reason(on_mill(&v1::MillService::Stub::PauseJob)), v1::REASON_WRONG_JOB_STATE);
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::PauseJob).ok());
  EXPECT_EQ(now().running().sending(), v1::SENDING_STATE_PAUSED);
  const std::int64_t written = now().running().written();
  watch_until([](const v1::Mill& mill) { return mill.running().executed_least() == mill.running().written(); });
  EXPECT_EQ(now().running().written(), written);
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::ResumeJob).ok());
  watch_until(job_is(job, v1::JOB_STATE_FED));
}

TEST_F(RpcMill, APausedJobWithTheToolUpIsConfirmedAndGoesOn) {
  const v1::Job job = sent(vectors(7));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  v1::PauseJobRequest pause;
  pause.set_device(kMill);
  pause.set_raise_tool(true);
  v1::PauseJobResponse paused;
  ASSERT_TRUE(ask(&v1::MillService::Stub::PauseJob, pause, &paused).ok());
  EXPECT_EQ(paused.running().sending(), v1::SENDING_STATE_RAISING);
  const v1::Job rest = watch_until(job_is(job, v1::JOB_STATE_PAUSED)).jobs(0);
  EXPECT_EQ(rest.setup().start().byte(), paused.running().written());
  EXPECT_EQ(rest.setup().start().line(), 1);
  EXPECT_EQ(rest.setup().start().column(), rest.setup().start().byte() + 1);
  EXPECT_EQ(reason(on_mill(&v1::MillService::Stub::ResumeJob)), v1::REASON_WRONG_JOB_STATE);
  EXPECT_EQ(reason(confirm(job)), v1::REASON_SETUP_CHANGED) << "seen from its beginning";
  ASSERT_TRUE(confirm(rest).ok());
  ASSERT_TRUE(start(rest).ok());
  watch_until(job_is(job, v1::JOB_STATE_FED));
}

TEST_F(RpcMill, SomebodyChoosesAnotherPlace) {
  const v1::Job job = sent("PA;VS15;\nPU400,400;\nPU0,400;\nPU400,400;\n" + vectors(4));
  v1::ContinueJobRequest request;
  request.set_job(job.name());
  request.set_line(3);
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::ContinueJob, request)), v1::REASON_WRONG_JOB_STATE)
      << "it has not begun";
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  v1::PauseJobRequest pause;
  pause.set_device(kMill);
  pause.set_raise_tool(true);
  ASSERT_TRUE(ask(&v1::MillService::Stub::PauseJob, pause).ok());
  watch_until(job_is(job, v1::JOB_STATE_PAUSED));
  request.set_line(0);
  const grpc::Status unnamed = ask(&v1::MillService::Stub::ContinueJob, request);
  EXPECT_EQ(reason(unnamed), v1::REASON_INVALID_REQUEST);
  EXPECT_THAT(unnamed.error_message(), HasSubstr("what the mill has executed of it ends at line "));
  request.set_line(99);
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::ContinueJob, request)), v1::REASON_INVALID_REQUEST);
  request.set_line(3);
  request.set_column(2);
  v1::ContinueJobResponse response;
  ASSERT_TRUE(ask(&v1::MillService::Stub::ContinueJob, request, &response).ok());
  EXPECT_EQ(response.job().state(), v1::JOB_STATE_PAUSED);
  EXPECT_EQ(response.job().setup().start().line(), 4) << "the next command";
  EXPECT_EQ(response.job().setup().start().column(), 1);
  EXPECT_EQ(response.job().setup().start().byte(), 29);
  request.set_line(0);
  EXPECT_EQ(ask(&v1::MillService::Stub::ContinueJob, request).error_message(), unnamed.error_message())
      << "not the place that was chosen";
  ASSERT_TRUE(confirm(response.job()).ok());
  ASSERT_TRUE(start(response.job()).ok());
  watch_until(job_is(job, v1::JOB_STATE_FED));
}

class RpcMillWithFlowControl : public RpcMill {
 protected:
  void configure(server::Config& config) override {
    RpcMill::configure(config);
    auto& mill = std::get<server::MillConfig>(config.devices.back().family);
    mill.sending.flow_control = true;
    mill.sending.converter = 0;
  }
};

TEST_F(RpcMillWithFlowControl, WhatHasLeftTheHostIsTaken) {
  const v1::Job job = sent(vectors(2000));
  ASSERT_TRUE(confirm(job).ok());
  ASSERT_TRUE(start(job).ok());
  watch_until([](const v1::Mill& mill) { return mill.running().written() > 0; });
  ASSERT_TRUE(on_mill(&v1::MillService::Stub::PauseJob).ok());
  const v1::RunningJob running =
      watch_until([](const v1::Mill& mill) { return mill.running().taken() == mill.running().written(); }).running();
  EXPECT_GT(running.taken(), running.executed_least()) << "moves of half a second";
}

TEST_F(RpcMill, AJobIsCancelled) {
  const v1::Job job = sent(vectors(4));
  v1::CancelJobRequest request;
  request.set_job(job.name());
  EXPECT_TRUE(ask(&v1::MillService::Stub::CancelJob, request).ok());
  EXPECT_THAT(now().jobs(), IsEmpty());
  EXPECT_EQ(reason(start(job)), v1::REASON_NOT_FOUND);
  EXPECT_EQ(sent(vectors(4)).name(), "devices/mill/jobs/2") << "no number is given twice";
}

TEST_F(RpcMill, AMillHasNoAxesAndAStageNoJobs) {
  v1::MoveRequest request = move_request(1, "1");
  request.set_device(kMill);
  EXPECT_EQ(reason(move(request)), v1::REASON_INVALID_REQUEST);
  v1::GetMillRequest mill;
  mill.set_device("devices/stage");
  EXPECT_EQ(reason(ask(&v1::MillService::Stub::GetMill, mill)), v1::REASON_INVALID_REQUEST);
}

}  // namespace
}  // namespace axisgate::rpc
