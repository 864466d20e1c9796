// The interrupt line of the host bus, for whichever interrupt controller is fitted. A PC senses its edges, so the line
// must rise anew for all that is left after a service: once it has fallen it stays low for IrqLowClocks, and a service
// (a clear, an acknowledge) makes it fall although requests remain. Leaves through a flip-flop. Clock clk_ref_i,
// asynchronous reset. docs/interrupt_controller.md, host-bus:3.5.
`default_nettype none

module host_interrupt (
  input  wire logic clk_ref_i,
  input  wire logic rst_ni,
  input  wire logic request_i,  // a line asks, its state after this edge
  input  wire logic served_i,   // one clk_ref: the host has served a request at this edge
  output logic      irq_o
);

  localparam logic [2:0] IrqLowClocks = 3'd4;  // 101.7 ns; an 8259A asks for 100 ns

  logic       irq_d, irq_q;
  logic [2:0] low_d, low_q;  // clocks that the line has still to be low after the next edge
  assign irq_d = request_i & ~served_i & (low_q == 3'd0);

  always_comb begin
    low_d = low_q;
    if (irq_q & ~irq_d)     low_d = IrqLowClocks - 3'd1;
    else if (low_q != 3'd0) low_d = low_q - 3'd1;
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      irq_q <= 1'b0;
      low_q <= 3'd0;
    end else begin
      irq_q <= irq_d;
      low_q <= low_d;
    end
  end

  assign irq_o = irq_q;

endmodule : host_interrupt

`default_nettype wire
