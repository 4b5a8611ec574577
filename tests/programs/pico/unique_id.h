// The number of a Pico's flash.
#pragma once
struct pico_unique_board_id_t {
    uint8_t id[8];
};
inline void pico_get_unique_board_id(pico_unique_board_id_t *number) {
    *number = {{0xe6, 0x61, 0, 0, 0, 0, 0, (uint8_t)board}};
}
