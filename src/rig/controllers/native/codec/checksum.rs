//! The checksum of the native protocol. In: bytes. Out: CRC-16/CCITT-FALSE.

/// CRC-16/CCITT-FALSE.
#[must_use]
pub fn checksum(bytes: &[u8]) -> u16 {
    bytes.iter().fold(0xffff, |sum: u16, byte| {
        let [high, low] = sum.to_be_bytes();
        u16::from_be_bytes([low, 0]) ^ REMAINDERS[usize::from(high ^ byte)]
    })
}

/// The remainder of the polynomial 1021 for each byte, shifted bit by bit.
const REMAINDERS: [u16; 256] = {
    let mut table = [0; 256];
    let mut byte: u16 = 0;
    while byte < 256 {
        let (mut sum, mut bit) = (byte << 8, 0);
        while bit < 8 {
            sum = if sum & 0x8000 == 0 {
                sum << 1
            } else {
                sum << 1 ^ 0x1021
            };
            bit += 1;
        }
        table[byte as usize] = sum;
        byte += 1;
    }
    table
};
