package axisgate;

import axisgate.v1.AbortJobRequest;
import axisgate.v1.CancelJobRequest;
import axisgate.v1.Capability;
import axisgate.v1.ConfirmJobRequest;
import axisgate.v1.GetMillRequest;
import axisgate.v1.Job;
import axisgate.v1.JogStep;
import axisgate.v1.MillServiceGrpc;
import axisgate.v1.OperateMillRequest;
import axisgate.v1.PauseJobRequest;
import axisgate.v1.RaiseTool;
import axisgate.v1.ReportJobDoneRequest;
import axisgate.v1.ResumeJobRequest;
import axisgate.v1.SetZ0;
import axisgate.v1.StartJobRequest;
import java.time.Duration;
import java.util.List;

/**
 * A Mill is the connection to one mill.
 *
 * <p>A mill never answers, so the progress of a job is a range that the daemon computes. Jobs and
 * states are the API's messages. A job is sent to the queue, confirmed by a person at the mill,
 * started, and reported as done. Not a safety function: use the mill's own emergency stop. Thread
 * safe.
 */
public final class Mill extends Device {
  private Mill(Session session) {
    super(session);
  }

  /**
   * Connects to the local daemon, or to that of the environment variables, and its only mill.
   *
   * @return the mill
   * @throws Unavailable if no daemon answers
   */
  public static Mill open() {
    return open(new ConnectOptions());
  }

  /**
   * Connects to a daemon and a mill.
   *
   * @param options names of the daemon and the mill, and other options
   * @return the mill
   * @throws Unavailable if no daemon answers
   * @throws IllegalArgumentException if there is no such mill, or the options contradict each other
   */
  public static Mill open(ConnectOptions options) {
    return new Mill(Session.open(options, Capability.CAPABILITY_JOBS));
  }

  /**
   * Returns the state of the mill: its queue, the running job, tools and origins.
   *
   * @return the state
   */
  public axisgate.v1.Mill read() {
    var request = GetMillRequest.newBuilder().setDevice(session.device).build();
    return session.ask(MillServiceGrpc.getGetMillMethod(), request).getMill();
  }

  /**
   * Returns the jobs in the order of the queue, with the running job.
   *
   * @return the jobs
   */
  public List<Job> jobs() {
    return read().getJobsList();
  }

  /**
   * Returns the state of the mill, now and after every change. A slow reader skips states.
   *
   * @return the states
   */
  public Updates<axisgate.v1.Mill> watch() {
    return new Updates<>(
        session.connection(), new MillSource(session.connection().channel, session.device));
  }

  /**
   * Puts a job into the queue, once, even if an answer is lost.
   *
   * @param parts contents of the job's files. The operator changes the tool between two parts
   * @param options description of the job
   * @return the job
   * @throws Refused if the check of the job finds an error, or a warning that is not accepted
   */
  public Job send(List<byte[]> parts, JobOptions options) {
    return JobSending.send(session, options.header(session.device, parts), parts);
  }

  /**
   * Confirms that a person has set up the mill as {@code job.getSetup()} says, for the next job or
   * its next part.
   *
   * @param job the job as it was seen
   * @return the job
   */
  public Job confirm(Job job) {
    var request =
        ConfirmJobRequest.newBuilder().setJob(job.getName()).setSeen(job.getSetup()).build();
    return session.change(MillServiceGrpc.getConfirmJobMethod(), request).getJob();
  }

  /**
   * Starts a confirmed job, or its next part.
   *
   * @param job the job
   * @return the job
   */
  public Job start(Job job) {
    var request = StartJobRequest.newBuilder().setJob(job.getName()).build();
    return session.change(MillServiceGrpc.getStartJobMethod(), request).getJob();
  }

  /**
   * Sends no more of the running job. The mill executes what it has received.
   *
   * @param raiseTool true if the tool is then raised
   */
  public void pause(boolean raiseTool) {
    var request =
        PauseJobRequest.newBuilder().setDevice(session.device).setRaiseTool(raiseTool).build();
    session.change(MillServiceGrpc.getPauseJobMethod(), request);
  }

  /** Continues a job that was paused with the tool in the cut. */
  public void resume() {
    var request = ResumeJobRequest.newBuilder().setDevice(session.device).build();
    session.change(MillServiceGrpc.getResumeJobMethod(), request);
  }

  /**
   * Ends the running job, discards the mill's buffer, raises the tool and stops the spindle. Needs
   * no lease.
   *
   * <p>The mill does not report whether it has done so. The abort is sent even if the thread is
   * interrupted, and again for half of the time limit if no daemon answers.
   */
  public void abort() {
    var request =
        AbortJobRequest.newBuilder()
            .setContext(session.leaseContext())
            .setDevice(session.device)
            .build();
    session.calls.stop(MillServiceGrpc.getAbortJobMethod(), request);
  }

  /**
   * Removes a job that does not run from the queue.
   *
   * @param job the job
   */
  public void cancel(Job job) {
    var request = CancelJobRequest.newBuilder().setJob(job.getName()).build();
    session.change(MillServiceGrpc.getCancelJobMethod(), request);
  }

  /**
   * Reports that a person has seen the workpiece of a job that is FED.
   *
   * @param job the job
   */
  public void reportDone(Job job) {
    var request = ReportJobDoneRequest.newBuilder().setJob(job.getName()).build();
    session.change(MillServiceGrpc.getReportJobDoneMethod(), request);
  }

  /**
   * Moves the tool by hand. Nothing checks where a step leads.
   *
   * @param x displacement to the right
   * @param y displacement away from the operator
   * @param z displacement upward
   * @return the longest time until the mill has done it
   */
  public Duration step(Distance x, Distance y, Distance z) {
    JogStep.Builder step = JogStep.newBuilder().setX(Distance.message(x)).setY(Distance.message(y));
    return operate(OperateMillRequest.newBuilder().setStep(step.setZ(Distance.message(z))));
  }

  /**
   * Sets Z0 at the present height of the tool.
   *
   * @return the longest time until the mill has done it
   */
  public Duration setZ0() {
    return operate(OperateMillRequest.newBuilder().setSurface(SetZ0.getDefaultInstance()));
  }

  /**
   * Sets Z0 at the height of a configured origin.
   *
   * @param origin name of the origin
   * @return the longest time until the mill has done it
   */
  public Duration setZ0(String origin) {
    return operate(
        OperateMillRequest.newBuilder().setSurface(SetZ0.newBuilder().setOrigin(origin)));
  }

  /**
   * Starts or stops the spindle.
   *
   * @param on true starts the spindle
   * @return the longest time until the mill has done it
   */
  public Duration spindle(boolean on) {
    return operate(OperateMillRequest.newBuilder().setSpindle(on));
  }

  /**
   * Raises the tool to the top, with the spindle stopped.
   *
   * @return the longest time until the mill has done it
   */
  public Duration raiseTool() {
    return operate(OperateMillRequest.newBuilder().setRaiseTool(RaiseTool.getDefaultInstance()));
  }

  private Duration operate(OperateMillRequest.Builder act) {
    var request = act.setDevice(session.device).build();
    var answer = session.change(MillServiceGrpc.getOperateMillMethod(), request);
    return Times.duration(answer.getLongestTime());
  }
}
