package axisgate

import "testing"

func found(environment map[string]string, options ...Option) (target, error) {
	s := newSettings(options)
	s.getenv = func(name string) string { return environment[name] }
	return newTarget(s)
}

func TestAddresses(t *testing.T) {
	for name, wanted := range map[string]string{"/run/a.sock": "unix:/run/a.sock", "a.sock": "unix:a.sock",
		"lab": "lab:50203", "lab:1": "lab:1", "[::1]": "[::1]:50203", "::1": "[::1]:50203", "[::1]:1": "[::1]:1",
		"unix:a": "unix:a"} {
		if target, err := found(nil, WithTarget(name)); err != nil || target.address != wanted {
			t.Error(target, err)
		}
	}
	if target, _ := found(nil, WithTarget("lab"), WithCA("file")); target.address != "lab:50204" {
		t.Error(target)
	}
}

func TestDialedAddresses(t *testing.T) {
	for address, wanted := range map[string]string{"unix:a": "unix:a", "lab:1": "passthrough:///lab:1",
		"ipv4:127.0.0.1:1": "passthrough:///127.0.0.1:1", "dns:lab": "dns:lab"} {
		if dialed := (target{address: address}).dialed(); dialed != wanted {
			t.Error(dialed)
		}
	}
}

func TestEnvironment(t *testing.T) {
	for _, test := range []struct {
		environment map[string]string
		options     []Option
		wanted      string
	}{
		{map[string]string{"AXISGATE_TARGET": "lab"}, nil, "lab:50203"},
		{map[string]string{"AXISGATE_TARGET": "lab"}, []Option{WithTarget("x.sock")}, "unix:x.sock"},
		{map[string]string{"AXISGATE_SOCKET": "/a"}, nil, "unix:/a"},
	} {
		if target, err := found(test.environment, test.options...); err != nil || target.address != test.wanted {
			t.Error(target, err)
		}
	}
}

func TestTokenIsNotSentInPlaintext(t *testing.T) {
	for _, local := range []string{"127.0.0.1", "localhost:1", "[::1]", "/a/b.sock", "ipv4:127.0.0.1:1"} {
		if _, err := found(nil, WithTarget(local), WithToken("secret")); err != nil {
			t.Error(err)
		}
	}
	for _, other := range []string{"lab", "127.0.0.1.example", "192.0.2.1:50203", "dns:lab", "unixbox"} {
		if _, err := found(nil, WithTarget(other), WithToken("secret")); !isA[*InvalidArgument](err) {
			t.Error(other, err)
		}
	}
	if _, err := found(nil, WithTarget("lab"), WithToken("secret"), WithCA("file")); err != nil {
		t.Error(err)
	}
	if _, err := found(nil, WithTarget("lab"), WithCertificate("file", "")); !isA[*InvalidArgument](err) {
		t.Error(err)
	}
}

func TestInheritedLease(t *testing.T) {
	if token, err := inheritedToken(""); err != nil || len(token) != 0 {
		t.Error(token, err)
	}
	for _, wrong := range []string{"zz", "00ff"} {
		if _, err := inheritedToken(wrong); !isA[*InvalidArgument](err) {
			t.Error(err)
		}
	}
}
