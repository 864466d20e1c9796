// Hardware watchdog: trips when 25 ms pass without a strobe from the firmware, or without an edge of the servo clock,
// or at once when the 5 V supply is no longer good, and stays tripped until reset. Two timers count a 38.4 kHz clock
// (clk_ref_i / 1024) down from 960. Both run from reset on. The relay is energised from reset to trip, so that a loss
// of power releases it too. Clock clk_ref_i, asynchronous reset. docs/watchdog.md, servo-ic:10.
`default_nettype none

module watchdog (
  input  wire logic clk_ref_i,
  input  wire logic rst_ni,
  input  wire logic strobe_i,  // one clk_ref: any write to X:$070011
  input  wire logic servo_i,
  input  wire logic pwr_good_i,  // a pin: 5 V is good
  output logic      trip_d_o,    // from the next edge on it has tripped
  output logic      trip_o,
  output logic      relay_o      // 1 energised
);

  localparam logic [9:0] Timeout = 10'd960;  // 25 ms

  logic [9:0] prescale_q, strobe_left_d, strobe_left_q, servo_left_d, servo_left_q;
  logic       good, servo1_q, servo2_q, trip_d, trip_q, relay_q;
  logic       count, servo_edge;
  assign count      = &prescale_q;
  assign servo_edge = servo1_q != servo2_q;

  sync2 #(.Reset(1'b1)) u_good_sync (.clk_i(clk_ref_i), .rst_ni, .d_i(pwr_good_i), .q_o(good));

  always_comb begin
    strobe_left_d = strobe_left_q;
    servo_left_d  = servo_left_q;
    trip_d        = trip_q | ~good;
    if (count && !trip_q) begin
      strobe_left_d = strobe_left_q - 10'd1;
      servo_left_d  = servo_left_q - 10'd1;
      if ((strobe_left_q == 10'd1 && !strobe_i) || (servo_left_q == 10'd1 && !servo_edge)) trip_d = 1'b1;
    end
    if (strobe_i) strobe_left_d = Timeout;
    if (servo_edge) servo_left_d = Timeout;
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      prescale_q    <= 10'd0;
      strobe_left_q <= Timeout;
      servo_left_q  <= Timeout;
      servo1_q      <= 1'b1;
      servo2_q      <= 1'b1;
      trip_q        <= 1'b0;
      relay_q       <= 1'b0;
    end else begin
      prescale_q    <= prescale_q + 10'd1;
      strobe_left_q <= strobe_left_d;
      servo_left_q  <= servo_left_d;
      servo1_q      <= servo_i;
      servo2_q      <= servo1_q;
      trip_q        <= trip_d;
      relay_q       <= ~trip_d;
    end
  end

  assign trip_d_o = trip_d;
  assign trip_o   = trip_q;
  assign relay_o  = relay_q;

endmodule : watchdog

`default_nettype wire
