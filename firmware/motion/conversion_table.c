#include "firmware/motion/conversion_table.h"

void conversion_table_initialize(void) {}
void conversion_table_changed(uint32_t instance) { (void)instance; }
void conversion_table_servo(void) {}
void conversion_table_pass(void) {}
bool conversion_table_is_result(uint32_t address) { return address != 0u; }
bool conversion_table_is_not_built(uint32_t address) { return address == 0u; }
