"""A gRPC proxy in front of the daemon. It passes all calls on as bytes, except for the calls of one method, which a
mutation answers (mutations.py)."""

import concurrent.futures
import os
import tempfile

import grpc

from messages import METHODS

NO_DEADLINE_S = 1e9  # gRPC reports more than this for a call without a deadline
MOST_CALLS = 200  # calls at the same time: more than the scenario begins
CHANNEL_OPTIONS = (
    ("grpc.enable_retries", 0),
    ("grpc.initial_reconnect_backoff_ms", 100),  # finds a daemon that was started again
    ("grpc.max_reconnect_backoff_ms", 500),
)
RAW = (None, None)  # instead of the classes of the request and of the answer: gRPC then passes bytes


class Proxy(grpc.GenericRpcHandler):
    """A Proxy listens at its own Unix socket, `socket`. Without a mutation it changes nothing."""

    def __init__(self, daemon_socket, mutation=None):
        self._mutation = mutation
        self._folder = tempfile.TemporaryDirectory(prefix="axisgate-proxy-")
        self.socket = os.path.join(self._folder.name, "proxy.sock")
        self._channel = grpc.insecure_channel(f"unix:{daemon_socket}", options=CHANNEL_OPTIONS)
        self._server = grpc.server(concurrent.futures.ThreadPoolExecutor(MOST_CALLS), [self])
        self._server.add_insecure_port(f"unix:{self.socket}")
        self._server.start()

    def service(self, details):
        """Returns the handler of a call. gRPC sends a single message as a stream of one message."""
        path = details.method
        is_mutated = self._mutation is not None and path in (self._mutation.path, self._mutation.also)
        answer = self._mutation.answer if is_mutated else pass_on
        classes = METHODS[path] if is_mutated else RAW

        def behave(requests, context):
            return _answers(Call(self._channel, path, classes, requests, context), answer)

        return grpc.stream_stream_rpc_method_handler(behave, _decode(classes[0]), _encode(classes[1]))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._server.stop(None).wait()
        self._channel.close()
        self._folder.cleanup()


class Call:
    """A Call is one call of a client. Its requests and answers are messages of `classes`, or bytes."""

    def __init__(self, channel, path, classes, requests, context):
        self._channel = channel
        self._path = path
        self._classes = classes
        self._context = context
        self._has_headers = False
        self.requests = requests

    def send(self, *requests):
        """Sends the requests to the daemon, by default those of the client, and yields its answers.

        Raises grpc.RpcError if the daemon refuses the call or does not answer.
        """
        sent = self._begin(self._path, self._classes, iter(requests) if requests else self.requests)
        headers = sent.initial_metadata()
        if not self._has_headers:
            self._has_headers = True
            self._context.send_initial_metadata(headers)
        yield from sent

    def ask(self, path, **fields):
        """Returns the daemon's answer to a request of another method."""
        return next(self._begin(path, METHODS[path], iter([METHODS[path][0](**fields)])))

    def end(self, error):
        """Ends the call with the status of an error, if the client is still there."""
        if self._context.is_active():
            self._context.set_trailing_metadata(error.trailing_metadata())
            self._context.set_code(error.code())
            self._context.set_details(error.details())

    def _begin(self, path, classes, requests):
        method = self._channel.stream_stream(path, _encode(classes[0]), _decode(classes[1]))
        left_s = self._context.time_remaining()
        metadata = [(key, value) for key, value in self._context.invocation_metadata() if key != "user-agent"]
        sent = method(requests, timeout=left_s if left_s < NO_DEADLINE_S else None, metadata=metadata)
        if not self._context.add_callback(sent.cancel):
            sent.cancel()  # the client has gone
        return sent


def pass_on(call):
    """Yields the daemon's answers unchanged."""
    yield from call.send()


def _answers(call, answer):
    """Yields the answers to a call, and ends it with the daemon's status."""
    try:
        yield from answer(call)
    except grpc.RpcError as error:
        call.end(error)


def _encode(kind):
    return kind and kind.SerializeToString


def _decode(kind):
    return kind and kind.FromString
