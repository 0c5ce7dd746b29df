package axisgate;

import io.grpc.Attributes;
import io.grpc.ClientStreamTracer;
import io.grpc.Metadata;

/**
 * A Reach notes whether gRPC had a connection for a call. Without it, no byte of the call was sent.
 */
final class Reach extends ClientStreamTracer.Factory {
  private volatile boolean reached;

  boolean reached() {
    return reached;
  }

  @Override
  public ClientStreamTracer newClientStreamTracer(
      ClientStreamTracer.StreamInfo info, Metadata headers) {
    return new ClientStreamTracer() {
      @Override
      public void streamCreated(Attributes transport, Metadata headers) {
        reached = true;
      }
    };
  }
}
