package axisgate;

import static axisgate.Units.deg;
import static axisgate.Units.mm;
import static axisgate.Units.nm;
import static axisgate.Units.pulses;
import static axisgate.Units.um;
import static org.junit.jupiter.api.Assertions.assertEquals;
import static org.junit.jupiter.api.Assertions.assertThrows;
import static org.junit.jupiter.api.Assertions.assertTrue;

import axisgate.v1.AxisJog;
import axisgate.v1.Rounding;
import java.math.BigDecimal;
import java.util.List;
import org.junit.jupiter.api.Test;

class UnitsTest {
  @Test
  void textsAndWholeNumbersAreExact() {
    assertEquals("1.5", Distance.message(mm("1.5")).getMm());
    assertEquals("2", Distance.message(mm(2)).getMm());
    assertEquals("-7", Distance.message(um(-7L)).getUm());
    assertEquals("1e3", Distance.message(nm(" 1e3 ")).getNm());
    assertEquals("0.10", Distance.message(mm(new BigDecimal("0.10"))).getMm());
    assertEquals(".5", Distance.message(deg("-.5").negate()).getDegrees());
    assertEquals(5, Distance.message(pulses(5)).getPulses());
  }

  @Test
  void floatingPointNumbersAreRoundedByTheDaemon() {
    var floating = Distance.message(mm(0.1 + 0.2)).getFloating();
    assertEquals(0.1 + 0.2, floating.getValue());
    assertEquals(axisgate.v1.Unit.UNIT_MILLIMETERS, floating.getUnit());
    assertEquals(Rounding.ROUNDING_NEAREST, floating.getRounding());
    assertEquals(1.5, Speed.message(um(-1.5).perSecond().negate()).getFloating().getValue());
  }

  @Test
  void amountsThatAreNone() {
    for (double wrong : new double[] {Double.NaN, Double.NEGATIVE_INFINITY}) {
      assertThrows(IllegalArgumentException.class, () -> mm(wrong));
    }
    for (String wrong : List.of("nan", "", "1,5", "0x1", ".", "1e")) {
      assertThrows(IllegalArgumentException.class, () -> mm(wrong), wrong);
    }
    assertThrows(NullPointerException.class, () -> Distance.message(null));
  }

  @Test
  void textOfAmounts() {
    assertEquals("1.50 mm", mm("1.50").toString());
    assertEquals("2.5 um", um(2.5).toString());
    assertEquals("-3 pulses/s", pulses(-3).perSecond().toString());
  }

  @Test
  void negativeSpeedsAreTheMinusDirection() {
    for (Speed speed :
        List.of(um("-2").perSecond(), um(2).perSecond().negate(), um(-2.0).perSecond())) {
      AxisJog jog = Requests.jog("x", speed);
      assertEquals(AxisJog.Direction.DIRECTION_MINUS, jog.getDirection());
      assertTrue(
          jog.getSpeed().getUmPerS().equals("2") || jog.getSpeed().getFloating().getValue() == 2);
    }
  }
}
