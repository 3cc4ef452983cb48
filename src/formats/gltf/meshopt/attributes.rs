//! Mode 0 (attributes), and the filters for its elements.

/// The elements in a group.
const GROUP: usize = 16;
/// The most elements in a block.
const BLOCK: usize = 256;

/// Decodes `count` elements of `stride` bytes; `None` if the bytes are not a complete stream of them.
pub(super) fn decode(source: &[u8], count: usize, stride: usize) -> Option<Vec<u8>> {
    if stride == 0 || stride > 256 || !stride.is_multiple_of(4) {
        return None;
    }
    let (&header, body) = source.split_first()?;
    let is_first = match header {
        0xA0 => true,
        0xA1 => false,
        _ => return None,
    };
    let channels = if is_first { 0 } else { stride / 4 };
    let padded = (stride + channels).max(if is_first { 32 } else { 24 });
    let (mut rest, padded) = body.split_at_checked(body.len().checked_sub(padded)?)?;
    let (_, tail) = padded.split_at_checked(padded.len() - stride - channels)?;
    let (baseline, modes) = tail.split_at_checked(stride)?;
    let mut last = baseline.to_vec();
    let most = ((8192 / stride) & !(GROUP - 1)).min(BLOCK);
    let (mut decoded, mut left) = (Vec::new(), count);
    while left > 0 {
        let elements = left.min(most);
        let controls = if is_first { None } else { Some(take(&mut rest, channels)?) };
        let begin = decoded.len();
        // limits the allocation by the bytes that are left: a block takes at least a byte for each channel
        decoded.resize(begin + elements * stride, 0);
        for (channel, last) in last.as_chunks_mut::<4>().0.iter_mut().enumerate() {
            let mut lanes = [[0; BLOCK]; 4];
            for (byte, lane) in lanes.iter_mut().enumerate() {
                let control = controls.map(|controls| controls.get(channel).map_or(0, |four| four >> (2 * byte) & 3));
                read_lane(&mut rest, control, elements, lane)?;
            }
            let mode = modes.get(channel).copied().unwrap_or(0);
            let out = decoded.get_mut(begin..)?.chunks_exact_mut(stride);
            for (element, out) in out.enumerate() {
                let deltas = lanes.each_ref().map(|lane| lane.get(element).copied().unwrap_or(0));
                *last = step(*last, deltas, mode)?;
                out.get_mut(channel * 4..channel * 4 + 4)?.copy_from_slice(last);
            }
        }
        left -= elements;
    }
    rest.is_empty().then_some(decoded)
}

/// The deltas of one byte of the elements in a block.
fn read_lane(rest: &mut &[u8], control: Option<u8>, elements: usize, lane: &mut [u8; BLOCK]) -> Option<()> {
    let widths: [u32; 4] = match control {
        None => [0, 2, 4, 8],
        Some(0) => [0, 1, 2, 4],
        Some(1) => [1, 2, 4, 8],
        Some(2) => return Some(()),
        Some(_) => {
            lane.get_mut(..elements)?.copy_from_slice(take(rest, elements)?);
            return Some(());
        }
    };
    let groups = elements.div_ceil(GROUP);
    let header = take(rest, groups.div_ceil(4))?;
    for (group, into) in lane.as_chunks_mut::<GROUP>().0.iter_mut().take(groups).enumerate() {
        let code = header.get(group / 4)? >> (2 * (group % 4)) & 3;
        read_group(rest, *widths.get(usize::from(code))?, into)?;
    }
    Some(())
}

fn read_group(rest: &mut &[u8], width: u32, into: &mut [u8; GROUP]) -> Option<()> {
    match width {
        0 => into.fill(0),
        8 => into.copy_from_slice(take(rest, GROUP)?),
        _ => {
            let packed = take(rest, GROUP * width as usize / 8)?;
            let (in_byte, sentinel) = (8 / width as usize, (1_u8 << width) - 1);
            for (at, into) in into.iter_mut().enumerate() {
                let place = (at % in_byte) as u32 * width;
                // single bits are packed from the least significant bit, wider values from the most significant
                let shift = if width == 1 { place } else { 8 - width - place };
                let code = packed.get(at / in_byte)? >> shift & sentinel;
                *into = if code == sentinel { *take(rest, 1)?.first()? } else { code };
            }
        }
    }
    Some(())
}

/// Four bytes of an element, from those of the previous one.
fn step(last: [u8; 4], deltas: [u8; 4], mode: u8) -> Option<[u8; 4]> {
    match (mode & 15, mode >> 4) {
        (0, 0) => {
            let zigzag = |delta: u8| (delta >> 1) ^ (delta & 1).wrapping_neg();
            let mut next = last;
            next.iter_mut().zip(deltas).for_each(|(byte, delta)| *byte = byte.wrapping_add(zigzag(delta)));
            Some(next)
        }
        (1, 0) => {
            let zigzag = |delta: u16| (delta >> 1) ^ (delta & 1).wrapping_neg();
            let add = |last: [u8; 2], delta: [u8; 2]| {
                u16::from_le_bytes(last).wrapping_add(zigzag(u16::from_le_bytes(delta))).to_le_bytes()
            };
            let ([a, b, c, d], [e, f, g, h]) = (last, deltas);
            let ([a, b], [c, d]) = (add([a, b], [e, f]), add([c, d], [g, h]));
            Some([a, b, c, d])
        }
        (2, turned) => {
            let delta = u32::from_le_bytes(deltas).rotate_right(turned.into());
            Some((u32::from_le_bytes(last) ^ delta).to_le_bytes())
        }
        _ => None,
    }
}

fn take<'a>(rest: &mut &'a [u8], count: usize) -> Option<&'a [u8]> {
    let (taken, behind) = rest.split_at_checked(count)?;
    *rest = behind;
    Some(taken)
}

/// Filter 3: an exponent in the high byte and a 24-bit mantissa, both signed, become a float.
pub(super) fn exponential(bytes: &mut [u8]) {
    for four in bytes.as_chunks_mut::<4>().0 {
        let stored = i32::from_le_bytes(*four);
        let (exponent, mantissa) = (stored >> 24, stored << 8 >> 8);
        *four = ((f64::from(mantissa) * f64::from(exponent).exp2()) as f32).to_le_bytes();
    }
}

/// Filter 2: three components of a rotation, and the index of the omitted one, become four 16-bit components.
pub(super) fn quaternion(bytes: &mut [u8]) {
    for eight in bytes.as_chunks_mut::<8>().0 {
        let (stored, _) = eight.as_chunks::<2>();
        let part = |at: usize| stored.get(at).map_or(0, |two| i16::from_le_bytes(*two));
        // the last component has the index of the omitted one, and the scale above it
        let (largest, one) = (part(3) & 3, part(3) | 3);
        let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(one);
        let [x, y, z] = [0, 1, 2].map(|at| f32::from(part(at)) * scale);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let mut parts = [0_i16; 4];
        for (step, value) in [(1, x), (2, y), (3, z), (4, w)] {
            if let Some(into) = parts.get_mut((largest as usize + step) % 4) {
                *into = (value * 32767.0).round() as i16;
            }
        }
        for (into, part) in eight.as_chunks_mut::<2>().0.iter_mut().zip(parts) {
            *into = part.to_le_bytes();
        }
    }
}
