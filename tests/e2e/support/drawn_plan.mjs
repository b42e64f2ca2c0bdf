/** A plan with four rooms along a corridor, as black lines on white, made by the browser itself; floors lie one below the other. */
export async function drawnPlan(page, floors = 1) {
  const base64 = await page.evaluate((floors) => {
    const canvas = document.createElement('canvas');
    [canvas.width, canvas.height] = [1200, 800 * floors];
    const context = canvas.getContext('2d');
    context.fillStyle = '#fff';
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.lineWidth = 9;
    const walls = [
      [100, 100, 1100, 100], [1100, 100, 1100, 700], [1100, 700, 100, 700], [100, 700, 100, 100],
      [100, 450, 280, 450], [360, 450, 760, 450], [840, 450, 1100, 450], [600, 100, 600, 450], [600, 550, 600, 700],
      [100, 550, 420, 550], [500, 550, 900, 550], [980, 550, 1100, 550],
    ];
    for (let floor = 0; floor < floors; floor++)
      for (const [x1, y1, x2, y2] of walls) {
        context.beginPath();
        context.moveTo(x1, y1 + 800 * floor);
        context.lineTo(x2, y2 + 800 * floor);
        context.stroke();
      }
    return canvas.toDataURL('image/png').split(',')[1];
  }, floors);
  return Buffer.from(base64, 'base64');
}
