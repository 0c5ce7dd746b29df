import static axisgate.v1.LinkState.LINK_STATE_UP;
import static axisgate.v1.MotionState.*;
import static java.util.concurrent.TimeUnit.MILLISECONDS;

import axisgate.v1.*;
import com.google.protobuf.ByteString;
import com.google.protobuf.Duration;
import io.grpc.*;
import io.grpc.Status.Code;
import io.grpc.stub.MetadataUtils;
import java.util.*;
import java.util.concurrent.*;
import java.util.concurrent.atomic.AtomicInteger;
import java.util.function.Supplier;

/** The rows of ../../../README.md, in its order. */
final class Rows {
  static final String STAGE = "devices/stage";
  private static final String MILL = "devices/mill";
  private static final String JOB = "^IN;!MC0;!PZ-50,200;" + "PU4000,0;PU0,0;".repeat(4000) + "H;\n";
  private static final GetDeviceRequest GET_STAGE = GetDeviceRequest.newBuilder().setDevice(STAGE).build();
  private static final GetDeviceRequest GET_STAGE_NOW =
      GET_STAGE.toBuilder().setMaxAge(com.google.protobuf.Duration.getDefaultInstance()).build();

  private final Channel channel;
  private final AccessServiceGrpc.AccessServiceBlockingStub access;
  private final CommandServiceGrpc.CommandServiceBlockingStub commands;
  private final DeviceServiceGrpc.DeviceServiceBlockingStub devices;
  private final EventServiceGrpc.EventServiceStub events;
  private final StageServiceGrpc.StageServiceBlockingStub stage;

  Rows(Channel channel) {
    this.channel = channel;
    access = AccessServiceGrpc.newBlockingStub(channel);
    commands = CommandServiceGrpc.newBlockingStub(channel);
    devices = DeviceServiceGrpc.newBlockingStub(channel);
    events = EventServiceGrpc.newStub(channel);
    stage = StageServiceGrpc.newBlockingStub(channel);
  }

  void run(String row) throws Exception {
    switch (row) {
      case "unary-front" -> unaryFront();
      case "unary-grpc" -> unaryGrpc();
      case "watch" -> watch();
      case "execute" -> execute();
      case "send-job" -> sendJob();
      case "jog" -> jog();
      case "keep-lease" -> keepLease();
      case "gzip" -> gzip();
      case "deadline" -> deadline();
      case "cancel" -> cancel();
      case "keepalive" -> keepalive();
      case "metadata" -> metadata();
      case "many" -> many();
      case "restart" -> restart();
      case "end-in-call" -> endInCall();
      default -> throw new Failure("row", row, "a row of README.md");
    }
  }

  private void unaryFront() {
    for (int i = 0; i < 200; i++) {
      getStage();
    }
    for (int i = 0; i < 200; i++) {
      var all = devices.listDevices(ListDevicesRequest.getDefaultInstance()).getDevicesList();
      Failure.expect("ListDevices", all.stream().map(Device::getName).sorted().toList(), List.of(MILL, STAGE));
    }
    var none = GetDeviceRequest.newBuilder().setDevice("devices/none").build();
    Failure.expect("GetDevice of no device", status(() -> devices.getDevice(none)).getCode(), Code.NOT_FOUND);
  }

  private void unaryGrpc() {
    for (int i = 0; i < 200; i++) {
      getCaller();
    }
    int count = commands.listCommands(ListCommandsRequest.newBuilder().setDevice(STAGE).build()).getCommandsCount();
    Failure.check(count > 50, "ListCommands", count, "more than 50");
    var none = GetMotionRequest.newBuilder().setMotion(STAGE + "/motions/999999999").build();
    Failure.expect("GetMotion of no motion", status(() -> stage.getMotion(none)).getCode(), Code.NOT_FOUND);
  }

  private void watch() throws InterruptedException {
    Watch watch = new Watch(events);
    for (int i = 0; i < 3; i++) {
      watch.move(stage);
    }
    watch.answers.call.cancel("cancelled by the row", null);
    Failure.expect("end of Watch", watch.end(), Code.CANCELLED);
  }

  private void execute() {
    for (int i = 0; i < 50; i++) {
      executeQuestions();
    }
    var unknown = ExecuteRequest.newBuilder().setDevice(STAGE).addLines("QQ:").build();
    Code code = status(() -> commands.execute(unknown).hasNext()).getCode();
    Failure.expect("Execute of QQ:", code, Code.INVALID_ARGUMENT);
  }

  private void sendJob() throws InterruptedException {
    var answers = beginJob(MillServiceGrpc.newStub(channel), "interop", JOB, 64);
    Job job = answers.need().getJob();
    Failure.expect("job.bytes", job.getBytes(), (long) JOB.length());
    Failure.expect("job.title", job.getTitle(), "interop");
    Failure.check(answers.next() == null, "SendJob", "a second answer", "one answer");
    Failure.expect("end of SendJob", answers.end(), Code.OK);
    MillServiceGrpc.newBlockingStub(channel).cancelJob(CancelJobRequest.newBuilder().setJob(job.getName()).build());
  }

  private void jog() throws InterruptedException {
    Answers<JogRequest, JogResponse> jog = beginJog();
    var faster = AxisJog.newBuilder().setAxis("2").setSpeed(Speed.newBuilder().setPulsesPerS(2000));
    jog.call.onNext(JogRequest.newBuilder().addAxes(faster).build());
    jog.call.onCompleted();
    Motion last = Motion.getDefaultInstance();
    for (JogResponse answer = jog.next(); answer != null; answer = jog.next()) {
      last = answer.getMotion();
    }
    Failure.expect("end of Jog", jog.end(), Code.OK);
    Failure.expect("last state of Jog", last.getState(), MOTION_STATE_SUCCEEDED);
  }

  private void keepLease() throws InterruptedException {
    var control = ControlServiceGrpc.newBlockingStub(channel);
    var terms = LeaseTerms.newBuilder().addAxes("3").setTimeToLive(Duration.newBuilder().setSeconds(10));
    var acquire = AcquireLeaseRequest.newBuilder().setDevice(STAGE).setTerms(terms).build();
    ByteString token = control.acquireLease(acquire).getLease().getToken();
    Failure.expect("bytes of the token", token.size(), 24);
    var keep = new Answers<KeepLeaseAliveRequest, KeepLeaseAliveResponse>();
    ControlServiceGrpc.newStub(channel).keepLeaseAlive(keep);
    for (int i = 0; i < 10; i++) {
      keep.call.onNext(KeepLeaseAliveRequest.newBuilder().setDevice(STAGE).setLeaseToken(token).build());
      Failure.expect("lease.axes", keep.need().getLease().getAxesList(), List.of(3));
    }
    keep.call.onCompleted();
    Failure.check(keep.next() == null, "KeepLeaseAlive", "an eleventh answer", "ten answers");
    Failure.expect("end of KeepLeaseAlive", keep.end(), Code.OK);
    var context = CallContext.newBuilder().setLeaseToken(token);
    control.releaseLease(ReleaseLeaseRequest.newBuilder().setContext(context).setDevice(STAGE).build());
  }

  /** Client compresses the requests. */
  private void gzip() throws InterruptedException {
    for (int i = 0; i < 20; i++) {
      getStage();
      getCaller();
      executeQuestions();
    }
    sendJob();
    System.out.println("note the library never compresses a message of 0 bytes (GetCaller)");
  }

  private void deadline() throws InterruptedException {
    long begin = System.nanoTime();
    var answers = new Answers<WatchRequest, WatchResponse>();
    events.withDeadlineAfter(500, MILLISECONDS).watch(WatchRequest.getDefaultInstance(), answers);
    Failure.expect("end of Watch", answers.end(), Code.DEADLINE_EXCEEDED);
    double seconds = (System.nanoTime() - begin) / 1e9;
    Failure.check(seconds >= 0.4 && seconds <= 5, "end of Watch", seconds + " s", "0.4 to 5 s after its beginning");
    getStage();
    getCaller();
  }

  private void cancel() throws InterruptedException {
    Answers<JogRequest, JogResponse> jog = beginJog();
    jog.call.cancel("cancelled by the row", null);
    Failure.expect("end of Jog", jog.end(), Code.CANCELLED);
    long begin = System.nanoTime();
    while (getStage(GET_STAGE_NOW).getAxes(1).getBusy()) {
      Failure.check(System.nanoTime() - begin < 10e9, "axis 2", "busy for 10 s", "not busy");
      Thread.sleep(50);
    }
    long position = getStage(GET_STAGE_NOW).getAxes(1).getPositionPulses();
    Failure.expect("position of axis 2 at rest", getStage(GET_STAGE_NOW).getAxes(1).getPositionPulses(), position);
  }

  private void keepalive() throws InterruptedException {
    Watch watch = new Watch(events);
    Thread.sleep(Client.KEEPALIVE_SECONDS * 2500 + 1000);
    watch.move(stage);
  }

  private void metadata() throws InterruptedException {
    Watch watch = new Watch(events);
    watch.event();
    for (int kib : List.of(8, 15, 40)) {
      var note = new Metadata();
      note.put(Metadata.Key.of("x-note", Metadata.ASCII_STRING_MARSHALLER), "a".repeat(kib * 1024));
      var attach = MetadataUtils.newAttachHeadersInterceptor(note);
      var caller = access.withInterceptors(attach);
      checkNoted("GetCaller", kib, status(() -> caller.getCaller(GetCallerRequest.getDefaultInstance())));
      var device = devices.withInterceptors(attach);
      checkNoted("GetDevice", kib, status(() -> device.getDevice(GET_STAGE)));
    }
    watch.move(stage);
  }

  /** Only a refusal by the library itself has a cause. */
  private static void checkNoted(String call, int kib, Status status) {
    String what = call + " with " + kib + " KiB";
    if (kib == 40 && String.valueOf(status.getCause()).contains("HeaderListSizeException")) {
      System.out.println("note " + what + ": the library refuses, " + status.getCode());
    } else {
      Failure.expect(what, status.getCode(), kib == 40 ? Code.RESOURCE_EXHAUSTED : Code.OK);
    }
  }

  private void many() throws Exception {
    Watch watch = new Watch(events);
    var stub = DeviceServiceGrpc.newFutureStub(channel);
    var begun = new ArrayList<Future<GetDeviceResponse>>();
    for (int i = 0; i < 500; i++) {
      begun.add(stub.getDevice(GET_STAGE));
    }
    for (int i = 0; i < 10; i++) {
      watch.move(stage);
    }
    for (Future<GetDeviceResponse> answer : begun) {
      Failure.expect("GetDevice", answer.get().getDevice().getName(), STAGE);
    }
  }

  private void restart() throws InterruptedException {
    Watch watch = new Watch(events);
    watch.move(stage);
    System.out.println("ready");
    Failure.expect("end of Watch", watch.end(), Code.UNAVAILABLE);
    Watch resumed = new Watch(events.withWaitForReady(), watch);
    while (!resumed.event().hasDaemonStarted()) {
      continue;
    }
    long begin = System.nanoTime();
    while (devices.getDevice(GET_STAGE).getDevice().getLink() != LINK_STATE_UP) {
      Failure.check(System.nanoTime() - begin < 30e9, "link", "not up for 30 s", "UP");
      Thread.sleep(50);
    }
  }

  private void endInCall() throws Exception {
    var mills = MillServiceGrpc.newStub(channel).withWaitForReady();
    var pool = Executors.newFixedThreadPool(4);
    var sent = new AtomicInteger();
    var all = new ArrayList<Callable<Void>>();
    for (int i = 0; i < 40; i++) {
      String title = "end-" + i;
      all.add(() -> {
        sendEndJob(mills, title, sent);
        return null;
      });
    }
    for (Future<Void> call : pool.invokeAll(all)) {
      call.get();
    }
  }

  private static void sendEndJob(MillServiceGrpc.MillServiceStub mills, String title, AtomicInteger sent)
      throws InterruptedException {
    Code code = beginJob(mills, title, "^IN;!MC0;PU0,0;H;\n", 4).end();
    System.out.println(code == Code.OK ? "sent " + title : "failed " + title + " " + code);
    if (code == Code.OK && sent.incrementAndGet() == 10) {
      System.out.println("ready");
    }
  }

  private Device getStage() {
    return getStage(GET_STAGE);
  }

  private Device getStage(GetDeviceRequest request) {
    Device device = devices.getDevice(request).getDevice();
    Failure.expect("GetDevice", device.getName() + " " + device.getLink(), STAGE + " " + LINK_STATE_UP);
    return device;
  }

  private void getCaller() {
    String who = access.getCaller(GetCallerRequest.getDefaultInstance()).getCaller().getName();
    Failure.check(!who.isEmpty(), "GetCaller", "no who", "a caller");
  }

  private void executeQuestions() {
    var request = ExecuteRequest.newBuilder().setDevice(STAGE).addAllLines(List.of("*IDN?", "Q:", "?:N"));
    Iterator<ExecuteResponse> answers = commands.execute(request.build());
    for (int line = 0; line < 3; line++) {
      Failure.check(answers.hasNext(), "Execute", line + " answers", "3 answers");
      ExecuteResponse answer = answers.next();
      Failure.check(answer.hasReply(), "Execute", answer, "a reply");
      Failure.expect("reply.line", answer.getReply().getLine(), line + 1);
      Failure.check(!answer.getReply().getAnswer().isEmpty(), "reply.answer", "nothing", "an answer");
    }
    Failure.check(!answers.hasNext(), "Execute", "a fourth answer", "OK");
  }

  /** Begins SendJob, sends the job in pieces of almost equal length, and closes the client's side. */
  private static Answers<SendJobRequest, SendJobResponse> beginJob(
      MillServiceGrpc.MillServiceStub mills, String title, String job, int pieces) {
    var answers = new Answers<SendJobRequest, SendJobResponse>();
    mills.sendJob(answers);
    var header = JobHeader.newBuilder().setDevice(MILL).setTitle(title).setTool("T1");
    answers.call.onNext(SendJobRequest.newBuilder().setHeader(header).build());
    for (int i = 0; i < pieces; i++) {
      String piece = job.substring(job.length() * i / pieces, job.length() * (i + 1) / pieces);
      answers.call.onNext(SendJobRequest.newBuilder().setData(ByteString.copyFromUtf8(piece)).build());
    }
    answers.call.onCompleted();
    return answers;
  }

  /** Begins a Jog of axis 2, and returns once it runs. */
  private Answers<JogRequest, JogResponse> beginJog() throws InterruptedException {
    var jog = new Answers<JogRequest, JogResponse>();
    StageServiceGrpc.newStub(channel).jog(jog);
    var axis = AxisJog.newBuilder().setAxis("2").setDirection(AxisJog.Direction.DIRECTION_PLUS)
        .setSpeed(Speed.newBuilder().setPulsesPerS(1000));
    jog.call.onNext(JogRequest.newBuilder().setDevice(STAGE).addAxes(axis).build());
    while (jog.need().getMotion().getState() != MOTION_STATE_RUNNING) {
      continue;
    }
    return jog;
  }

  private static Status status(Supplier<?> call) {
    try {
      call.get();
      return Status.OK;
    } catch (StatusRuntimeException e) {
      return e.getStatus();
    }
  }
}
