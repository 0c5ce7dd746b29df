package main

import (
	"errors"
	"fmt"
	"iter"
	"strconv"
	"time"

	"axisgate.example/go/axisgate"
)

// errPoint is what a program of a user returns while it computes a path.
var errPoint = errors.New("a point cannot be computed")

// An act is one line of the scenario.
type act struct {
	Say, Axis, Motion, Lease, Unit      string
	Target, Token, CA, Certificate, Key *string
	Amount, From, To, Every, Speed      amount
	Axes, Step                          []string
	Count, Calls                        int
	FailsAfter                          int     `json:"fails_after"`
	InterruptAfter                      float64 `json:"interrupt_after"`
	TTL, Within, Timeout                float64
}

// An amount has a text, which is exact, or a number: 1.5, "nan" or "inf". A careless program gives no unit.
type amount struct {
	Text   string
	Number any
	Unit   string
}

func (a amount) distance() axisgate.Distance {
	if a.Text != "" {
		return withUnit(a.Text, a.Unit)
	}
	number, _ := strconv.ParseFloat(fmt.Sprint(a.Number), 64)
	return withUnit(number, a.Unit)
}

// withUnit returns the zero Distance for a bare number, which the compiler does not accept as a Distance.
func withUnit[N axisgate.Number](number N, unit string) axisgate.Distance {
	switch unit {
	case "mm":
		return axisgate.MM(number)
	case "um":
		return axisgate.UM(number)
	}
	return axisgate.Distance{}
}

func (a act) speed() axisgate.Speed { return a.Speed.distance().PerSecond() }

func (a act) options() []axisgate.MoveOption {
	if a.Speed == (amount{}) {
		return nil
	}
	return []axisgate.MoveOption{axisgate.WithSpeed(a.speed())}
}

// points are numbered points of a line, which fail after a while if the act says so.
func (a act) points() iter.Seq2[axisgate.Point, error] {
	return func(yield func(axisgate.Point, error) bool) {
		for number := 1; number <= a.Count; number++ {
			var err error
			if a.FailsAfter != 0 && number > a.FailsAfter {
				err = errPoint
			}
			var point axisgate.Point
			for _, step := range a.Step {
				size, _ := strconv.Atoi(step)
				point = append(point, withUnit(number*size, a.Unit))
			}
			if !yield(point, err) {
				return
			}
		}
	}
}

// connection returns the options of an act that opens a Stage.
func (a act) connection() []axisgate.Option {
	var options []axisgate.Option
	add := func(option func(string) axisgate.Option, text *string) {
		if text != nil {
			options = append(options, option(*text))
		}
	}
	add(axisgate.WithTarget, a.Target)
	add(axisgate.WithToken, a.Token)
	add(axisgate.WithCA, a.CA)
	if a.Certificate != nil {
		options = append(options, axisgate.WithCertificate(*a.Certificate, *a.Key))
	}
	return options
}

func seconds(s float64) time.Duration { return time.Duration(s * float64(time.Second)) }
