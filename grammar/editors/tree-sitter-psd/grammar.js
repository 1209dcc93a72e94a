/**
 * The tree-sitter grammar of psd plans. `grammar/psd.pest` is the grammar of the program. This one accepts more: it knows no words of the
 * schema, so that a new block, field or option needs no change here. The queries name them.
 *
 * A newline is an extra, which is skipped, except where `_end` may come: after an item or a field. Inside brackets and after an operator
 * it cannot come there.
 */

const PRECEDENCE = {
  and: 1,
  compare: 2,
  range: 3,
  add: 4,
  multiply: 5,
  negate: 6,
  power: 7,
  postfix: 8,
};

const NAME = /[A-Za-zµμ][A-Za-zµμ0-9_]*/;
const FACTOR = seq(choice('%', NAME), optional(/\^-?[0-9]+(\.[0-9]+)?/));

/** Items in commas; the last may have one too. */
function listed(item) {
  return optional(seq(item, repeat(seq(',', item)), optional(',')));
}

module.exports = grammar({
  name: 'psd',

  extras: $ => [/\s/, $.comment],

  word: $ => $.identifier,

  supertypes: $ => [$._item, $._expression],

  rules: {
    source_file: $ => optional(lines($._item, $._end)),

    _item: $ => choice($.use, $.parameter, $.let, $.requirement, $.block),
    use: $ => seq('use', field('path', $.string)),
    parameter: $ => seq('param', field('name', alias($.identifier, $.name)), '=', field('value', $._expression), optional(seq('between', field('range', $._expression)))),
    let: $ => seq('let', field('name', alias($.identifier, $.name)), '=', field('value', $._expression)),
    requirement: $ => seq('require', field('text', $.string), field('condition', $._expression)),

    // `stiffness ramp k0 { … }`: of several words the last one is the name.
    block: $ => seq(
      field('kind', alias($.identifier, $.keyword)),
      optional(seq(repeat(field('kind', alias($.identifier, $.keyword))), field('name', alias($.identifier, $.name)))),
      optional(field('title', $.string)),
      field('body', $.fields),
    ),
    fields: $ => seq('{', optional(lines($.field, $._end)), '}'),
    field: $ => seq(field('key', alias($.identifier, $.key)), '=', field('value', $._expression)),

    _expression: $ => choice(
      $.binary,
      $.within,
      $.stepped,
      $.range,
      $.negation,
      $.member,
      $.index,
      $.call,
      $.list,
      $.parenthesised,
      $.quantity,
      $.string,
      $.identifier,
    ),
    binary: $ => choice(...[
      ['and', PRECEDENCE.and, prec.left],
      [choice('<', '<=', '>', '>=', '==', '!=', '~'), PRECEDENCE.compare, prec.left],
      [choice('+', '-'), PRECEDENCE.add, prec.left],
      [choice('*', '/'), PRECEDENCE.multiply, prec.left],
      ['^', PRECEDENCE.power, prec.right],
    ].map(([operator, precedence, associative]) =>
      associative(precedence, seq(field('left', $._expression), field('operator', operator), field('right', $._expression))))),
    within: $ => prec.left(PRECEDENCE.compare, seq($._expression, 'within', $._expression, 'of', $._expression)),
    // Only a name can be stepped, so that `3 in` is three inches.
    stepped: $ => prec.left(PRECEDENCE.compare, seq(choice($.identifier, $.member), 'in', $._expression)),
    range: $ => prec.left(PRECEDENCE.range, seq($._expression, '..', $._expression, optional(seq('step', $._expression)))),
    negation: $ => prec(PRECEDENCE.negate, seq('-', $._expression)),
    member: $ => prec(PRECEDENCE.postfix, seq(field('of', $._expression), '.', field('member', alias($.identifier, $.key)), optional($.arguments))),
    index: $ => prec(PRECEDENCE.postfix, seq(field('of', $._expression), '[', field('position', $._expression), ']')),
    call: $ => prec(PRECEDENCE.postfix, seq(field('name', alias($.identifier, $.function)), $.arguments)),
    arguments: $ => seq('(', listed($.argument), ')'),
    argument: $ => seq(optional(seq(field('name', alias($.identifier, $.key)), ':')), field('value', $._expression)),
    list: $ => prec.right(seq('[', listed($._expression), ']', optional($._unit))),
    parenthesised: $ => seq('(', $._expression, ')'),
    quantity: $ => prec.right(seq($.number, optional($._unit))),

    // A unit of one ASCII name is also an identifier. The longer token is the unit.
    identifier: _ => /[A-Za-z_][A-Za-z0-9_]*/,
    _unit: $ => choice(alias($.identifier, $.unit), $.unit),
    unit: _ => token(seq(choice('1/', ''), FACTOR, repeat(seq(/[*\/]/, FACTOR)))),
    number: _ => /[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?/,

    string: $ => seq('"', repeat(choice($._text, $.escape)), token.immediate('"')),
    _text: _ => token.immediate(prec(1, /[^"\\\r\n]+/)),
    escape: _ => token.immediate(/\\["\\nt]/),

    comment: _ => /#[^\r\n]*/,
    _end: _ => '\n',
  },
});

/** Entries that end with their lines; the last may end with the text around it. */
function lines(entry, end) {
  return seq(entry, repeat(seq(end, entry)), optional(end));
}
