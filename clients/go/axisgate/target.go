package axisgate

import (
	"crypto/tls"
	"crypto/x509"
	"fmt"
	"os"
	"path/filepath"
	"regexp"
	"strings"

	"google.golang.org/grpc/credentials"
	"google.golang.org/grpc/credentials/insecure"
)

const (
	systemSocket = "/run/axisgate/axisgate.sock"
	port         = "50203"
	tlsPort      = "50204"
)

var (
	grpcName = regexp.MustCompile(`^(unix|unix-abstract|dns|ipv4|ipv6):`)
	local    = regexp.MustCompile(
		`^(unix(-abstract)?:.*|(ipv[46]:|dns:/*)?(localhost|127\.[0-9.]+|\[::1\]|::1)(:\d+)?)$`)
)

// A target is the daemon's address in gRPC's form, with what identifies the caller.
type target struct {
	address              string
	token                string
	tls                  bool
	ca, certificate, key string
}

// newTarget returns the target that the arguments and the environment name.
func newTarget(s settings) (target, error) {
	chosen := func(argument *string, variable string) string {
		if argument != nil {
			return *argument
		}
		return s.getenv(variable)
	}
	t := target{token: chosen(s.token, "AXISGATE_TOKEN"), ca: chosen(s.ca, "AXISGATE_CA"),
		certificate: chosen(s.certificate, "AXISGATE_CERTIFICATE"), key: chosen(s.key, "AXISGATE_KEY")}
	if (t.certificate == "") != (t.key == "") {
		return t, invalid("certificate and key must be given together")
	}
	t.tls = t.ca != "" || t.certificate != ""
	t.address = addressOf(chosen(s.target, "AXISGATE_TARGET"), t.tls, s.getenv)
	if t.token != "" && !t.tls && !t.isLocal() {
		return t, invalid("the token is not sent unencrypted to %s: use WithCA or set AXISGATE_CA", t.address)
	}
	return t, nil
}

// isLocal reports whether the daemon runs on this machine.
func (t target) isLocal() bool {
	return local.MatchString(t.address)
}

// dialed returns the address in the form of grpc.NewClient, which has no names for plain IP addresses.
func (t target) dialed() string {
	for _, scheme := range []string{"ipv4:", "ipv6:"} {
		if rest, found := strings.CutPrefix(t.address, scheme); found {
			return "passthrough:///" + rest
		}
	}
	if grpcName.MatchString(t.address) {
		return t.address
	}
	return "passthrough:///" + t.address
}

// credentials returns the credentials of a connection.
func (t target) credentials() (credentials.TransportCredentials, error) {
	if !t.tls {
		return insecure.NewCredentials(), nil
	}
	config := &tls.Config{MinVersion: tls.VersionTLS12}
	if t.ca != "" {
		content, err := os.ReadFile(t.ca)
		if err != nil {
			return nil, err
		}
		config.RootCAs = x509.NewCertPool()
		if !config.RootCAs.AppendCertsFromPEM(content) {
			return nil, invalid("%s has no certificate", t.ca)
		}
	}
	if t.certificate != "" {
		pair, err := tls.LoadX509KeyPair(t.certificate, t.key)
		if err != nil {
			return nil, err
		}
		config.Certificates = []tls.Certificate{pair}
	}
	return credentials.NewTLS(config), nil
}

func addressOf(name string, tls bool, getenv func(string) string) string {
	switch {
	case name == "":
		return "unix:" + defaultSocket(getenv)
	case grpcName.MatchString(name):
		return name
	case strings.Contains(name, "/") || strings.HasSuffix(name, ".sock"):
		return "unix:" + name
	case tls:
		return withPort(name, tlsPort)
	}
	return withPort(name, port)
}

func withPort(host, port string) string {
	bracketed := strings.HasPrefix(host, "[")
	switch {
	case bracketed && !strings.HasSuffix(host, "]"), !bracketed && strings.Count(host, ":") == 1:
		return host
	case !bracketed && strings.Contains(host, ":"):
		return fmt.Sprintf("[%s]:%s", host, port)
	}
	return host + ":" + port
}

func defaultSocket(getenv func(string) string) string {
	if chosen := getenv("AXISGATE_SOCKET"); chosen != "" {
		return chosen
	}
	if _, err := os.Stat(systemSocket); err == nil || os.Geteuid() == 0 {
		return systemSocket
	}
	if runtime := getenv("XDG_RUNTIME_DIR"); runtime != "" {
		return filepath.Join(runtime, "axisgate.sock")
	}
	return fmt.Sprintf("/tmp/axisgate-%d/axisgate.sock", os.Geteuid())
}
