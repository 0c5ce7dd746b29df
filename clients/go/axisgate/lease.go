package axisgate

import (
	"context"
	"errors"
	"slices"
	"sync"
	"time"

	"google.golang.org/protobuf/types/known/durationpb"

	axisgatev1 "axisgate.example/go/axisgate/v1"
)

const usualTTL = 10 * time.Second

// LeaseTerms are the terms of a lease.
type LeaseTerms struct {
	// Axes are the names or numbers of the axes. Empty: the whole device.
	Axes []string
	// Wait is the longest wait for the axes. 0: do not wait.
	Wait time.Duration
	// TTL is the time after which the lease ends when the program or the connection has failed. 0: 10 s.
	TTL time.Duration
	// FinishAtLoss lets a running motion end first when the lease is lost. Otherwise the motion is stopped.
	FinishAtLoss bool
	// Purpose is a text for other callers.
	Purpose string
}

// A Lease is the exclusive right to move some axes. A goroutine keeps it alive until Release.
//
//	lease, err := stage.Lease(ctx, axisgate.LeaseTerms{Axes: []string{"x", "y"}})
//	if err != nil {
//		return err
//	}
//	defer lease.Release(ctx)
//	ctx = lease.Context(ctx)
//
// Calls with that context carry the lease. A lease is lost if it cannot be kept alive, or if an administrator takes the
// axes over. Motion under it then fails with LEASE_LOST.
type Lease struct {
	session *deviceSession
	message *axisgatev1.Lease
	ttl     time.Duration

	keeping context.Context
	end     context.CancelFunc
	ended   chan struct{}
	lost    chan struct{}
	release sync.Once
	problem error // is set before `lost` is closed
}

// Lease acquires the exclusive right to axes, or to the whole device. It returns an error that matches [LeaseHeld] if
// the axes are not free.
func (s *Stage) Lease(ctx context.Context, terms LeaseTerms) (*Lease, error) {
	if terms.TTL == 0 {
		terms.TTL = usualTTL
	}
	answer, err := change(ctx, s.session, s.session.control.AcquireLease, terms.request(s.session.device), terms.Wait)
	if err != nil {
		if ctx.Err() != nil {
			return nil, ctx.Err() // the daemon releases a lease whose answer is not received
		}
		return nil, err
	}
	lease := &Lease{session: s.session, message: answer.Lease, ttl: terms.TTL, ended: make(chan struct{}),
		lost: make(chan struct{})}
	lease.keeping, lease.end = context.WithCancel(s.session.open)
	if !s.session.spawn(lease.keep) {
		return nil, ErrClosed
	}
	return lease, nil
}

func (t LeaseTerms) request(device string) *axisgatev1.AcquireLeaseRequest {
	terms := &axisgatev1.LeaseTerms{Axes: t.Axes, TimeToLive: durationpb.New(t.TTL), Purpose: t.Purpose,
		AtLoss: axisgatev1.AtLoss_AT_LOSS_STOP}
	if t.FinishAtLoss {
		terms.AtLoss = axisgatev1.AtLoss_AT_LOSS_FINISH
	}
	request := &axisgatev1.AcquireLeaseRequest{Device: device, Terms: terms}
	if t.Wait > 0 {
		request.Wait = durationpb.New(t.Wait)
	}
	return request
}

// Context returns a context with which calls carry the lease. A lease in a context replaces that of the parent.
func (l *Lease) Context(parent context.Context) context.Context {
	return context.WithValue(parent, leaseKey{l.session}, l.message.Token)
}

// Token returns the token of the lease. It is a secret: every program that has it can use the lease.
func (l *Lease) Token() []byte { return slices.Clone(l.message.Token) }

// Axes returns the numbers of the axes. Empty: the whole device.
func (l *Lease) Axes() []int { return numbers(l.message.Axes) }

// Lost returns a channel that is closed once the lease is lost.
func (l *Lease) Lost() <-chan struct{} { return l.lost }

// Err returns why the lease was lost, or nil.
func (l *Lease) Err() error {
	select {
	case <-l.lost:
		return l.problem
	default:
		return nil
	}
}

// HandOver gives the axes to a waiting caller, such as "unix anna". The lease then ends.
//
// It returns a Refused if this caller does not wait for exactly these axes, or while a motion runs under the lease.
func (l *Lease) HandOver(ctx context.Context, caller string) error {
	request := &axisgatev1.HandOverLeaseRequest{Device: l.session.device, Caller: caller}
	if _, err := change(l.Context(ctx), l.session, l.session.control.HandOverLease, request, 0); err != nil {
		return err
	}
	l.release.Do(l.endKeeping)
	return nil
}

// Release ends the lease. A motion that runs under it continues. Release is sent even if ctx has ended. It has no
// effect on a lease that has ended.
func (l *Lease) Release(ctx context.Context) (err error) {
	l.release.Do(func() {
		l.endKeeping()
		if l.Err() != nil {
			return
		}
		ctx := l.Context(context.WithoutCancel(ctx))
		request := &axisgatev1.ReleaseLeaseRequest{Device: l.session.device}
		_, err = change(ctx, l.session, l.session.control.ReleaseLease, request, 0)
	})
	return err
}

func (l *Lease) endKeeping() {
	l.end()
	<-l.ended
}

// keep renews the lease until it is released or lost.
func (l *Lease) keep() {
	defer close(l.ended)
	kept := time.Now()
	ticker := time.NewTicker(l.ttl / 3)
	defer ticker.Stop()
	for {
		select {
		case <-l.keeping.Done():
			return
		case <-ticker.C:
		}
		err := l.renew()
		switch {
		case l.keeping.Err() != nil:
			return
		case err == nil:
			kept = time.Now()
		case !passes(err):
			l.lose(err)
			return
		case time.Since(kept) > l.ttl:
			l.lose(asRefused(Problem{Reason: LeaseLost, Message: "the lease has expired: " + err.Error()}))
			return
		}
	}
}

func (l *Lease) renew() error {
	ctx, cancel := context.WithTimeout(l.keeping, l.ttl)
	defer cancel()
	request := &axisgatev1.RenewLeaseRequest{Device: l.session.device,
		Context: &axisgatev1.CallContext{LeaseToken: l.message.Token}}
	_, err := ask(ctx, l.session.connection, l.session.control.RenewLease, request, 0)
	return err
}

// passes reports whether a renewal that failed may succeed a moment later.
func passes(err error) bool {
	return errors.Is(err, ErrUnavailable) || errors.Is(err, Reason("QUEUE_FULL")) ||
		errors.Is(err, context.DeadlineExceeded)
}

func (l *Lease) lose(err error) {
	l.session.logger.Warn("the lease was lost", "error", err)
	l.problem = err
	close(l.lost)
}
