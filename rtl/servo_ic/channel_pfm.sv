// Pulse frequency modulation: each PFM_CLK adds the signed command to a 24-bit accumulator; an overflow makes a
// positive pulse, an underflow a negative one. Clock clk_ref_i, asynchronous reset. docs/servo_channel.md, PFM.
`default_nettype none

module channel_pfm (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        run_i,
  input  wire logic        pfm_ce_i,
  input  wire logic        sclk_ce_i,
  input  wire logic [23:0] command_i,
  input  wire logic [7:0]  width_i,      // PFM_CLK periods, 0 as 1
  output logic             pulse_o,
  output logic             down_o,       // direction of the last pulse
  output logic             event_o       // a pulse began since the last SCLK
);

  // At most a quarter of PFM_CLK.
  localparam logic [23:0] Limit = 24'h400000;
  logic [23:0] acc_q, size, step;
  logic [24:0] sum;
  logic [7:0]  left_q;
  logic        pulse_q, down_q, event_q;
  assign size = command_i[23] ? -command_i : command_i;
  assign step = size > Limit ? Limit : size;
  assign sum  = command_i[23] ? {1'b0, acc_q} - {1'b0, step} : {1'b0, acc_q} + {1'b0, step};

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      acc_q  <= 24'd0;
      down_q <= 1'b0;
    end else if (run_i && pfm_ce_i) begin
      acc_q <= sum[23:0];
      if (sum[24]) down_q <= command_i[23];
    end
  end

  // No reset: without run_i the next edge ends a pulse, SCLK forgets that one began.
  always_ff @(posedge clk_ref_i) begin
    if (sclk_ce_i) event_q <= 1'b0;
    if (!run_i) begin
      pulse_q <= 1'b0;
    end else if (pfm_ce_i) begin
      if (sum[24]) begin
        left_q  <= width_i == 8'd0 ? 8'd0 : width_i - 8'd1;
        pulse_q <= 1'b1;
        event_q <= 1'b1;
      end else if (left_q != 8'd0) begin
        left_q <= left_q - 8'd1;
      end else begin
        pulse_q <= 1'b0;
      end
    end
  end

  assign pulse_o = pulse_q;
  assign down_o  = down_q;
  assign event_o = event_q;

endmodule : channel_pfm

`default_nettype wire
