package axisgate

import (
	"bytes"
	"context"
	"encoding/binary"
	"fmt"
	"io"
	"net"
	"os"
	"os/exec"
	"path/filepath"
	"regexp"
	"runtime"
	"strings"
	"sync"
	"syscall"
	"testing"
	"time"
)

const testLimit = 30 * time.Second

// testConfig is the daemon's configuration. The stage runs on a pseudo-terminal of its own, so that it survives the
// daemon.
const testConfig = `
listen = "127.0.0.1:0"
metrics = "127.0.0.1:0"
socket = "SOCKET"
[journal]
kept = JOURNAL
[[device]]
name = "stage"
connection = "serial"
path = "TTY"
[[device.axis]]
number = 1
name = "x"
unit = "mm"
travel_minimum = "-15mm"
travel_maximum = "15mm"
[[device.axis]]
number = 2
name = "y"
unit = "mm"
`

// A daemon is the daemon of one test, and the simulator that it serves.
type daemon struct {
	t         *testing.T
	folder    string
	socket    string
	process   *exec.Cmd
	log       string
	simulator *exec.Cmd
}

// newDaemon starts a daemon, which ends with the test. The test fails if it leaves goroutines behind.
func newDaemon(t *testing.T, journal bool) *daemon {
	bin := os.Getenv("AXISGATE_BIN")
	if bin == "" {
		bin = "../../../build/bin"
	}
	if _, err := os.Stat(filepath.Join(bin, "axisgated")); err != nil {
		t.Skip("AXISGATE_BIN does not name the folder of the daemon's programs")
	}
	checkLeaks(t)
	folder, err := os.MkdirTemp("", "axisgate-go-")
	if err != nil {
		t.Fatal(err)
	}
	t.Cleanup(func() { os.RemoveAll(folder) })
	d := &daemon{t: t, folder: folder, socket: filepath.Join(folder, "axisgate.sock")}
	tty := filepath.Join(folder, "tty")
	d.simulator = exec.Command(filepath.Join(bin, "shrc203-sim"), "--pty", tty, "--speed", "4", "--control",
		filepath.Join(folder, "control"))
	if err := d.simulator.Start(); err != nil {
		t.Fatal(err)
	}
	t.Cleanup(func() { end(d.simulator) })
	until(t, "the simulator's terminal", func() bool { _, err := os.Stat(tty); return err == nil })
	config := strings.NewReplacer("SOCKET", d.socket, "TTY", tty, "JOURNAL", fmt.Sprint(journal)).Replace(testConfig)
	if err := os.WriteFile(d.path("axisgate.toml"), []byte(config), 0o600); err != nil {
		t.Fatal(err)
	}
	d.process = exec.Command(filepath.Join(bin, "axisgated"))
	d.start()
	t.Cleanup(d.kill)
	return d
}

func (d *daemon) path(name string) string { return filepath.Join(d.folder, name) }

// start starts the daemon, and waits until its controller answers.
func (d *daemon) start() { d.startUntil("stage: link is UP") }

// restartWithoutController restarts the daemon, whose controller then does not answer.
func (d *daemon) restartWithoutController() {
	d.simulator.Process.Signal(syscall.SIGSTOP)
	d.kill()
	d.startUntil("gRPC on")
}

// startUntil starts the daemon, and waits until its log has a text.
func (d *daemon) startUntil(ready string) {
	d.process = exec.Command(d.process.Path, "--config", d.path("axisgate.toml"))
	d.process.Env = append(os.Environ(), "STATE_DIRECTORY="+d.path("state"))
	log, err := os.Create(d.path("log"))
	if err != nil {
		d.t.Fatal(err)
	}
	defer log.Close()
	d.process.Stdout, d.process.Stderr = log, log
	if err := d.process.Start(); err != nil {
		d.t.Fatal(err)
	}
	until(d.t, "a ready daemon", func() bool {
		content, _ := os.ReadFile(d.path("log"))
		d.log = string(content)
		return strings.Contains(d.log, ready)
	})
}

func (d *daemon) kill() { end(d.process) }

func end(process *exec.Cmd) {
	process.Process.Kill()
	process.Wait()
}

// address returns the daemon's TCP address, whose callers are anonymous.
func (d *daemon) address() string {
	return regexp.MustCompile(`gRPC on (\S+) and`).FindStringSubmatch(d.log)[1]
}

// atStage does what a person at the simulated stage does, such as "unplug 3".
func (d *daemon) atStage(action string) {
	control, err := net.Dial("unix", d.path("control"))
	if err != nil {
		d.t.Fatal(err)
	}
	defer control.Close()
	fmt.Fprintln(control, action)
	answer := make([]byte, 256)
	if count, _ := control.Read(answer); !bytes.HasPrefix(answer[:count], []byte("ok")) {
		d.t.Fatalf("%s: %s", action, answer[:count])
	}
}

// open returns a Stage that is closed with the test. Without options it is that of the daemon's socket.
func (d *daemon) open(options ...Option) *Stage {
	stage, err := Open(context.Background(), append([]Option{WithTarget(d.socket)}, options...)...)
	if err != nil {
		d.t.Fatal(err)
	}
	d.t.Cleanup(func() { stage.Close() })
	return stage
}

// openOther returns the Stage of another program.
func (d *daemon) openOther() *Stage {
	defer func(own string) { session = own }(session)
	session = newUUID()
	return d.open(WithTarget(d.address()))
}

func until(t *testing.T, what string, happened func() bool) {
	t.Helper()
	for limit := time.Now().Add(testLimit); !happened(); time.Sleep(10 * time.Millisecond) {
		if time.Now().After(limit) {
			t.Fatalf("waited in vain: %s", what)
		}
	}
}

// checkLeaks fails the test if more goroutines run, or more descriptors are open, after it than before.
func checkLeaks(t *testing.T) {
	goroutines, descriptors := runtime.NumGoroutine(), openDescriptors()
	t.Cleanup(func() {
		limit := time.Now().Add(5 * time.Second)
		for runtime.NumGoroutine() > goroutines || openDescriptors() > descriptors {
			if time.Now().After(limit) {
				stacks := make([]byte, 1<<16)
				t.Fatalf("%d descriptors were open, %d are; goroutines: %s", descriptors, openDescriptors(),
					stacks[:runtime.Stack(stacks, true)])
			}
			time.Sleep(10 * time.Millisecond)
		}
	})
}

// openDescriptors returns the number of open descriptors on Linux, and otherwise 0.
func openDescriptors() int {
	entries, _ := os.ReadDir("/proc/self/fd")
	return len(entries)
}

// A relay passes bytes between clients and the daemon's socket, and cuts connections once the daemon answers.
type relay struct {
	socket   string
	upstream string
	listener net.Listener

	mutex       sync.Mutex
	cuts, left  int
	firstStream uint32
	connections []net.Conn
}

func newRelay(t *testing.T, d *daemon) *relay {
	r := &relay{socket: d.path("relay.sock"), upstream: d.socket}
	var err error
	if r.listener, err = net.Listen("unix", r.socket); err != nil {
		t.Fatal(err)
	}
	go r.serve()
	t.Cleanup(r.end)
	return r
}

// cutAnswers drops the answers to a stream of HTTP/2 (1, 3, 5, ... of each connection) and closes the connection. After
// the first cut, the first answer on each new connection is dropped, `times` times in all.
func (r *relay) cutAnswers(stream uint32, times int) {
	r.mutex.Lock()
	defer r.mutex.Unlock()
	r.firstStream, r.left = stream, times
}

func (r *relay) end() {
	r.listener.Close()
	r.mutex.Lock()
	defer r.mutex.Unlock()
	for _, one := range r.connections {
		one.Close()
	}
}

func (r *relay) serve() {
	for {
		client, err := r.listener.Accept()
		if err != nil {
			return
		}
		daemon, err := net.Dial("unix", r.upstream)
		if err != nil {
			client.Close()
			continue
		}
		r.mutex.Lock()
		r.connections = append(r.connections, client, daemon)
		r.mutex.Unlock()
		go func() {
			io.Copy(daemon, client)
			daemon.Close()
		}()
		go func() {
			r.answer(daemon, client)
			client.Close()
			daemon.Close()
		}()
	}
}

func (r *relay) answer(daemon, client net.Conn) {
	var frames frames
	buffer := make([]byte, 1<<16)
	for {
		count, err := daemon.Read(buffer)
		if err != nil || r.isCut(frames.streams(buffer[:count])) {
			return
		}
		if _, err := client.Write(buffer[:count]); err != nil {
			return
		}
	}
}

func (r *relay) isCut(streams []uint32) bool {
	r.mutex.Lock()
	defer r.mutex.Unlock()
	for _, stream := range streams {
		if r.left > 0 && stream >= r.firstStream {
			r.cuts++
			r.left--
			r.firstStream = 1
			return true
		}
	}
	return false
}

// frames are the frames of HTTP/2 that a daemon sends on one connection (RFC 9113, 4.1).
type frames struct{ unread []byte }

// streams takes bytes. It returns the numbers of the streams whose headers or data begin in them.
func (f *frames) streams(data []byte) []uint32 {
	f.unread = append(f.unread, data...)
	var found []uint32
	for len(f.unread) >= 9 {
		length := int(f.unread[0])<<16 | int(binary.BigEndian.Uint16(f.unread[1:]))
		if len(f.unread) < 9+length {
			break
		}
		if f.unread[3] <= 1 {
			found = append(found, binary.BigEndian.Uint32(f.unread[5:]))
		}
		f.unread = f.unread[9+length:]
	}
	return found
}
