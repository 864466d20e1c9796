// The peer in Verilog, for Icarus: vvp bench.vvp +writes=FILE +steps=N +flip=0|1. What it plays stands in peer.h.
`timescale 1ns / 1ns
module bench;
  reg clk_pwm = 0, clk_ref = 0, rst_n = 1;
  reg sel = 0, x = 0, we = 0;
  reg [4:0] addr = 0;
  reg [23:0] wdata = 0;
  reg [47:0] pins;
  wire [23:0] rdata;
  wire [63:0] motor;
  servo_ic dut (
    .clk_pwm_i(clk_pwm), .clk_ref_i(clk_ref), .rst_ni(rst_n), .sel_i(sel), .x_i(x), .addr_i(addr), .we_i(we),
    .wdata_i(wdata), .rd_i(1'b0), .rdata_o(rdata), .phase_i(1'b1), .servo_i(1'b1), .trip_i(1'b0), .trip_d_i(1'b0),
    .pins_i(pins), .adc_a_i(4'd0), .adc_b_i(4'd0), .motor_o(motor), .phase_o(), .servo_o(),
    .phase_oe_o(), .servo_oe_o(), .equ_o()
  );

  integer now = 0, steps = 0, flip = 0, file, step, mark = 1, address, value;
  reg [1023:0] name;
  reg [63:0] sum = 0;

  task run_until(input integer last);
    while (now < last) begin
      now = now + 1;
      #1;
      clk_pwm = 1;
      if (now % 3 == 0) clk_ref = 1;
      #1;
      clk_pwm = 0;
      clk_ref = 0;
    end
  endtask

  // Icarus 11 does not look at an index on the left of an assignment: it sees another channel with another sel_i.
  task select(input integer at);
    begin
      sel = 0;
      x = at[2];
      addr = at[7:3];
      #0 sel = 1;
    end
  endtask

  function [11:0] channel(input integer at);
    case (at % 4)
      0: channel = 12'hF80;
      1: channel = 12'hF81;
      2: channel = 12'hF83;
      default: channel = 12'hF82;
    endcase
  endfunction

  task set_pins(input integer at);
    pins = {channel(at + 3), channel(at + 2), channel(at + 1), channel(at)} ^ flip;
  endtask

  initial begin
    if (!$value$plusargs("writes=%s", name) || !$value$plusargs("steps=%d", steps) ||
        !$value$plusargs("flip=%d", flip)) $finish;
    set_pins(0);
    #1 rst_n = 0;
    #1 rst_n = 1;
    #1;
    file = $fopen(name, "r");
    for (step = 1; $fscanf(file, "%h %h", address, value) == 2; step = step + 1) begin
      run_until(9 * step - 1);
      select(address);
      we = 1;
      wdata = value;
      run_until(now + 1);
      we = 0;
    end
    for (step = 0; step <= steps; step = step + 1) begin
      case (step % 4)
        0: select(4);
        1: select(12);
        2: select(20);
        default: select(0);
      endcase
      run_until(240 + 60 * step);
      sum = 31 * sum + rdata;
      sum = 31 * sum + motor;
      if (step == mark || step == steps) begin
        $display("%0d %h", step, sum);
        while (mark <= step) mark = mark * 10;
      end
      set_pins(step + 1);
    end
    $finish;
  end
endmodule
