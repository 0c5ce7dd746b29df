package axisgate

import (
	"io"
	"log/slog"
	"math"
	"os"
	"time"
)

// An Option is an argument of [Open]. Without it, the value comes from the environment.
type Option func(*settings)

// settings are the arguments of Open. Text that is nil comes from the environment.
type settings struct {
	target, token, ca, certificate, key *string

	device  string
	timeout time.Duration
	logger  *slog.Logger
	getenv  func(string) string
}

// noLogger discards everything.
var noLogger = slog.New(slog.NewTextHandler(io.Discard, &slog.HandlerOptions{Level: slog.Level(math.MaxInt)}))

func newSettings(options []Option) settings {
	s := settings{timeout: 10 * time.Second, logger: noLogger, getenv: os.Getenv}
	for _, option := range options {
		option(&s)
	}
	return s
}

// WithTarget names the daemon: the path of a Unix socket, or HOST[:PORT]. Without it: $AXISGATE_TARGET, or the local
// daemon.
func WithTarget(target string) Option { return func(s *settings) { s.target = &target } }

// WithToken gives the caller's token. Without it: $AXISGATE_TOKEN. A token is never sent unencrypted to another
// machine.
func WithToken(token string) Option { return func(s *settings) { s.token = &token } }

// WithCA names the file of the authority that signed the daemon's certificate, and so chooses TLS. Without it:
// $AXISGATE_CA.
func WithCA(file string) Option { return func(s *settings) { s.ca = &file } }

// WithCertificate names the files of the caller's own certificate and key for TLS. Without it: $AXISGATE_CERTIFICATE
// and $AXISGATE_KEY.
func WithCertificate(certificate, key string) Option {
	return func(s *settings) { s.certificate, s.key = &certificate, &key }
}

// WithDevice names the stage. Without it: the only stage of the daemon.
func WithDevice(name string) Option { return func(s *settings) { s.device = name } }

// WithTimeout sets the time limit of each call. Without it: 10 s. While the limit is in its first half, a request whose
// answer is lost is sent again; the daemon acts once.
func WithTimeout(limit time.Duration) Option { return func(s *settings) { s.timeout = limit } }

// WithLogger makes the Stage log each call at the level Debug, and lost leases at the level Warn.
func WithLogger(logger *slog.Logger) Option { return func(s *settings) { s.logger = logger } }
